// Positions that decisions needed, kept for the next triangles that the same tile meets: where light grazes a
// wall, one tile may need the same sixteen points thousands of times.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include <tenebra/visible_points.h>
#include "points/point_tiles.h"

namespace tenebra::shadow {

/// Of one thread and one trace.
class PositionCache {
public:
  void clear() {
    for (Tile& tile : tiles_) tile.known = 0;
  }

  const glm::dvec3& at(const VisiblePoints& points, const TriangleView& triangles, std::uint32_t number,
                       int lane, std::size_t pixel) {
    Tile& tile = tiles_[number % tiles_.size()];
    if (tile.number != number) tile.number = number, tile.known = 0;
    const auto i = static_cast<std::size_t>(lane);
    if (((tile.known >> i) & 1u) == 0) tile.positions[i] = visible_position(points, triangles, pixel);
    tile.known |= 1u << i;
    return tile.positions[i];
  }

private:
  struct Tile {
    std::uint32_t number = 0;
    std::uint32_t known = 0;  ///< bits of the lanes whose positions are there
    std::array<glm::dvec3, points::tile_points> positions;
  };
  std::array<Tile, 64> tiles_{};
};

}  // namespace tenebra::shadow
