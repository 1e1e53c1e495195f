// Triangles of a frame, set up and sorted into tiles. Internal to visibility.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/records.h"
#include "visibility/setup_kernels.h"
#include "visibility/tile_kernels.h"

namespace tenebra::visibility {

/// What all bins of a drawing share.
struct Drawing {
  const Window& window;
  const CloseCalls& close;
  const WindowVertices& vertices;
  std::span<const std::uint8_t> see_through;  ///< of FrameGeometry
  bool draws_see_through = false;             ///< else: what is opaque
  SetupKernels kernels;
  int tiles_x = 0;
  int tiles_y = 0;
  double around_px = 0;  ///< how far from a pixel's centre, each way, it is looked at

  std::size_t tiles() const { return static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y); }
};

/// Records of a run of triangles, by tile.
class Bin {
public:
  /// Starts with triangles first ... last - 1.
  void begin(std::size_t first, std::size_t last) { next_ = first, last_ = last; }
  bool is_done() const { return next_ >= last_; }
  /// Forgets the records it has, and makes more: until its triangles end or it has `most` or a little more.
  void fill(const Drawing& drawing, std::size_t most);

  const TileRecord* records() const { return records_.data(); }
  std::span<const std::uint32_t> of_tile(std::size_t tile) const {
    return {order_.data() + starts_[tile], starts_[tile + 1] - starts_[tile]};
  }

private:
  void choose(const Drawing& drawing, std::size_t first, std::size_t last);
  void add_eight(const Drawing& drawing, std::size_t first, std::size_t count);
  void add(const Drawing& drawing, std::size_t candidate, const TriangleSetup8& setup, int k);
  void add_to_tile(std::uint32_t id, std::size_t candidate, const TriangleSetup8& setup, int k, int turn,
                   int tile_x, int tile_y, const Drawing& drawing);
  /// A triangle that is in one tile alone.
  void add_alone(std::uint32_t id, std::size_t candidate, const TriangleSetup8& setup, int k, int tile_x,
                 int tile_y, const Drawing& drawing);
  struct PixelBox {
    int x0, y0, x1, y1;
  };
  void finish_record(TileRecord& record, std::uint32_t id, std::size_t candidate, bool doubtful,
                     const PixelBox& box, int tile_x, int tile_y, const Drawing& drawing);
  void sort(std::size_t tiles);

  std::size_t next_ = 0, last_ = 0;
  Candidates candidates_;
  std::size_t chosen_ = 0;
  std::vector<TileRecord> records_;
  std::vector<std::uint32_t> tiles_;   // of each record
  std::vector<std::uint32_t> order_;   // records, by tile
  std::vector<std::uint32_t> starts_;  // in order_, of each tile and the end
};

}  // namespace tenebra::visibility
