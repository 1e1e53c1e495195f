// Positions that decisions needed, kept for the next triangles that the same tile meets: where light grazes a
// wall, one tile may need the same sixteen points thousands of times, in turn with all others of its root.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/visible_points.h>
#include "points/point_tiles.h"
#include "points/positions.h"

namespace tenebra::shadow {

/// Positions of a tile's points, of those that were needed.
struct alignas(64) TilePositions {
  double x[points::tile_points] = {}, y[points::tile_points] = {}, z[points::tile_points] = {};

  glm::dvec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
};

/// Positions that one thread has worked out in one trace. Most traces need none: memory is taken with the
/// first.
class PositionCache {
public:
  void clear() {
    if (used_) std::fill(known_.begin(), known_.end(), Known{});
    used_ = false;
  }

  /// Tile `number` with the positions of `lanes`, whose pixels `pixels` names.
  const TilePositions& of(points::PositionFinder& finder, const points::TilePixels& pixels,
                          std::uint32_t number, std::uint32_t lanes) {
    if (known_.empty()) known_.resize(kept), positions_.resize(kept);
    used_ = true;
    Known& known = known_[number % kept];
    TilePositions& at = positions_[number % kept];
    if (known.number != number) known = {number, 0};
    for (std::uint32_t left = lanes & ~known.lanes; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const glm::dvec3 p = finder.at(pixels(number, lane));
      at.x[lane] = p.x, at.y[lane] = p.y, at.z[lane] = p.z;
    }
    known.lanes |= lanes;
    return at;
  }

private:
  static constexpr std::size_t kept = 4096;  ///< tiles, as many as a root has: 1.6 MB
  struct Known {
    std::uint32_t number = 0;
    std::uint32_t lanes = 0;  ///< bits of those whose positions are there
  };
  std::vector<Known> known_;
  std::vector<TilePositions> positions_;
  bool used_ = false;
};

}  // namespace tenebra::shadow
