// What is done to the sixteen points of a tile, sixteen at a time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>
#include "points/point_tiles.h"
#include "points/receiver.h"

namespace tenebra::points {

/// The points of a tile's lanes.
struct alignas(64) TilePoints {
  double x[tile_points], y[tile_points], z[tile_points];

  glm::dvec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, const glm::dvec3& p) { x[lane] = p.x, y[lane] = p.y, z[lane] = p.z; }
};

/// Code for one instruction set.
struct PointTileKernels {
  /// The tile whose first pixel is `at`, all points of which lie on one triangle: q, its box as that of tile
  /// `place` of the square, and the radius. Below zero: nothing is said, as not all lie inside of it.
  float (*see_whole)(const Receiver& receiver, const PixelRays& rays, glm::uvec2 at, const glm::vec3& base,
                     PointTile& tile, int place, PointSquare& square) = nullptr;
  /// Points of the tile whose first pixel is `at`, all on one triangle or each on its own. Returns the bits
  /// of those that lie inside of their triangles; the others are left to PixelRays::point_on. The operations
  /// of the scalar code in the same order, so the same bits.
  std::uint32_t (*see_one)(const Receiver& receiver, const PixelRays& rays, glm::uvec2 at,
                           TilePoints& out) = nullptr;
  std::uint32_t (*see_several)(const Receiver* const of[tile_points], const PixelRays& rays, glm::uvec2 at,
                               TilePoints& out) = nullptr;
  /// Points from four rows of positions, `width` apart.
  void (*take)(const glm::dvec3* first, std::size_t width, TilePoints& out) = nullptr;
  /// q from the points of the lanes in `lanes` (not 0). Returns a radius: >= |q| of all.
  float (*fill)(const TilePoints& points, const glm::vec3& base, std::uint32_t lanes,
                PointTile& tile) = nullptr;
  /// Lanes of `lanes` (not 0) beyond a gap: farther from the first of them than the others by half of the
  /// extent.
  std::uint32_t (*beyond_gap)(const PointTile& tile, std::uint32_t lanes) = nullptr;
  /// Box around q of the lanes in `lanes` (not 0) as that of tile `place` of a square.
  void (*bound)(const PointTile& tile, std::uint32_t lanes, int place, PointSquare& square) = nullptr;
};
PointTileKernels point_tile_kernels(SimdLevel level);

}  // namespace tenebra::points
