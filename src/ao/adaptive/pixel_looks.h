// Pixels of a frame that cast rays of their own ("look"), tile by tile: through the triangles near the tile.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/adaptive/adaptive_pass.h"

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

class PixelLooks {
public:
  /// Finds what is near and builds its trees.
  PixelLooks(const AdaptiveScene& scene, const PixelSurfaces& surfaces, const StopFlag* stop);

  const PixelTiles& tiles() const { return tiles_; }
  /// Which pixels of a tile look, in any order.
  using Choice = std::function<void(int tile, std::vector<std::uint32_t>& pixels)>;
  /// What one found.
  using Take = std::function<void(std::uint32_t pixel, const Openness& found)>;
  /// Tile by tile, on all threads: `choose`, rays, `take`. The patterns alternate over the lattice of `step`.
  void look(int step, const RaySets& sets, const Choice& choose, const Take& take);

  std::uint64_t rays_cast() const;
  std::uint64_t looks() const;  ///< of all pixels

private:
  struct Worker {
    NearTriangles triangles;
    std::vector<std::uint32_t> pixels;
    std::vector<Receiver> receivers;
    std::vector<const RayPattern*> patterns;
    std::vector<Openness> found;
  };
  void find_near(const PixelSurfaces& surfaces);
  void make_receivers(int step, const RaySets& sets, Worker& worker) const;

  AdaptiveScene scene_;
  PixelTiles tiles_;
  const StopFlag* stop_;
  std::vector<std::vector<int>> near_;  ///< occluders, one list for each tile
  std::vector<OccluderCounts> counts_;  ///< one for each tile
  std::vector<std::uint64_t> looks_;    ///< one for each tile
  std::vector<Worker> workers_;         ///< one for each thread
};

}  // namespace tenebra::ao
