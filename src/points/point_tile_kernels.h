// What is done to the sixteen points of a tile, sixteen at a time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>
#include "points/point_tiles.h"

namespace tenebra::points {

/// Where the four rows of a tile's points stand: in the picture, or, where that ends, in a copy.
class TileRows {
public:
  /// `first`: position of the first pixel of `at`'s row; `size`: of the picture; `at`: the tile's first
  /// pixel.
  TileRows(const glm::dvec3* first, glm::uvec2 size, glm::uvec2 at);
  TileRows(const TileRows&) = delete;
  TileRows& operator=(const TileRows&) = delete;

  const glm::dvec3* operator[](int row) const { return rows_[row]; }
  const glm::dvec3& point(int lane) const { return rows_[(lane / 4) & 3][lane % 4]; }

private:
  const glm::dvec3* rows_[4];
  glm::dvec3 copies_[4][4];
};

/// Code for one instruction set.
struct PointTileKernels {
  /// q from the points of the lanes in `lanes` (not 0). Returns a radius: >= |q| of all.
  float (*fill)(const TileRows& rows, const glm::vec3& base, std::uint32_t lanes, PointTile& tile) = nullptr;
  /// Lanes of `lanes` (not 0) beyond a gap: farther from the first of them than the others by half of the
  /// extent.
  std::uint32_t (*beyond_gap)(const PointTile& tile, std::uint32_t lanes) = nullptr;
  /// Box around q of the lanes in `lanes` (not 0) as that of tile `place` of a square.
  void (*bound)(const PointTile& tile, std::uint32_t lanes, int place, PointSquare& square) = nullptr;
};
PointTileKernels point_tile_kernels(SimdLevel level);

}  // namespace tenebra::points
