// The opponent's rays: one Fibonacci lattice of directions, shifted from pixel to pixel (Cranley and
// Patterson 1976), so that neighbours see different directions and a filter may take the mean of them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace tenebra::bench {

/// A ray of sixteen neighbouring pixels: directions about +z, unit, as the lanes of TileShape::square lie.
struct alignas(64) PatternRow {
  float x[16], y[16], z[16];
};

/// Shifts stay within a cell of the lattice, as shifts by more than a cell give the same sets of points in
/// another order: so ray i of neighbouring pixels runs into the same part of the hemisphere, and sixteen of
/// them make a coherent packet. All shifts together fill the cell: of 4x4 pixels as sixteen points of a Sobol
/// sequence do, with few rays of 16x16 pixels as 256 do.
class AoScenePattern {
public:
  explicit AoScenePattern(int rays);
  int rays() const { return rays_; }
  /// The rays of the 4x4 pixels that start at (x, y), multiples of 4; `rays()` rows.
  const PatternRow* rows(int x, int y) const {
    const int tile = (x / 4) % side_ + (y / 4) % side_ * side_;
    return rows_.data() + std::size_t(tile) * std::size_t(rays_);
  }

private:
  int rays_, side_;  // side_: tiles each way until the shifts repeat
  std::vector<PatternRow> rows_;
};

}  // namespace tenebra::bench
