// Pixels of a frame that cast rays of their own ("look"), tile by tile: through the triangles near the tile.
#pragma once

#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/adaptive/adaptive_pass.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

/// Squares of the picture, the unit of work.
struct PixelTiles {
  static constexpr int side = 32;
  int width = 0, height = 0, columns = 0, rows = 0;

  PixelTiles(int w, int h)
      : width(w), height(h), columns((w + side - 1) / side), rows((h + side - 1) / side) {}
  int count() const { return columns * rows; }
  /// Calls pixel(x, y) for those of a tile on the lattice of `step`.
  template <class F>
  void each(int tile, int step, const F& pixel) const {
    const int x0 = tile % columns * side, y0 = tile / columns * side;
    for (int y = y0; y < std::min(y0 + side, height); y += step)
      for (int x = x0; x < std::min(x0 + side, width); x += step) pixel(x, y);
  }
};

/// Lists that are kept from frame to frame.
struct LookRoom {
  struct Worker {
    NearTriangles triangles;
    std::vector<std::uint32_t> pixels;
    std::vector<Receiver> receivers;
    std::vector<const RayPattern*> patterns;
    std::vector<Openness> found;
  };
  std::vector<std::vector<int>> near;    ///< casters, one list for each tile
  std::vector<int> all;                  ///< of all tiles
  std::vector<std::uint64_t> rays_cast;  ///< one for each tile
  std::vector<std::uint64_t> looks;      ///< one for each tile
  std::vector<Worker> workers;           ///< one for each thread
};

class PixelLooks {
public:
  /// Finds what is near and builds its trees. Keeps references to `room`, and to what `scene` has.
  PixelLooks(const AdaptiveScene& scene, const PixelSurfaces& surfaces, const StopFlag* stop, LookRoom& room);

  const PixelTiles& tiles() const { return tiles_; }
  /// (tile, pixels): which pixels of a tile look, in any order.
  using Choice = parallel::Body<int, std::vector<std::uint32_t>&>;
  /// (pixel, found): what one found.
  using Take = parallel::Body<std::uint32_t, const Openness&>;
  /// Tile by tile, on all threads: `choose`, rays, `take`. The patterns alternate over the lattice of `step`.
  void look(int step, const RaySets& sets, Choice choose, Take take);

  std::uint64_t rays_cast() const;
  std::uint64_t looks() const;  ///< of all pixels

private:
  void find_near(const PixelSurfaces& surfaces);
  void make_receivers(int step, const RaySets& sets, LookRoom::Worker& worker) const;

  AdaptiveScene scene_;
  PixelTiles tiles_;
  const StopFlag* stop_;
  LookRoom& room_;
};

}  // namespace tenebra::ao
