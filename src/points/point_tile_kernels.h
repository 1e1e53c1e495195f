// Kernels for the sixteen points of a tile, all at once.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>
#include "points/point_tiles.h"
#include "points/receiver.h"
#include "points/seen_plane.h"

namespace tenebra::points {

/// The points of a tile's lanes.
struct alignas(64) TilePoints {
  double x[tile_points], y[tile_points], z[tile_points];

  glm::dvec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, const glm::dvec3& p) { x[lane] = p.x, y[lane] = p.y, z[lane] = p.z; }
};

/// Code for one instruction set.
struct PointTileKernels {
  /// Copies ids; those that are not below `count` become no_triangle.
  void (*copy_ids)(std::span<const std::uint32_t> ids, std::size_t count, std::uint32_t* to) = nullptr;
  /// Bits of the lanes whose ids are the same, by their first lanes; returns how many different ids there
  /// are.
  int (*part_lanes)(const std::uint32_t ids[tile_points], std::uint16_t parts[tile_points]) = nullptr;
  /// Does what `see` and `fill` do, for the tile whose first pixel is `at`, with points on `parts` (one or
  /// more; numbers in `receivers`). Returns false, and writes nothing, if a point does not lie inside its
  /// triangle.
  bool (*see_whole)(const Receiver* receivers, std::span<const ReceiverLanes> parts, const PixelRays& rays,
                    glm::uvec2 at, const glm::vec3& base, PointTile& tile, int place,
                    PointSquare& square) = nullptr;
  /// Makes points in float, for a tile all of whose pixels see one receiver from the eye of a perspective
  /// view. Returns false, and writes nothing, where a point might not lie inside the triangle or floats do
  /// not reach. `error` grows to what q may be off.
  bool (*see_plane)(const SeenPlane& plane, const RayRows& rows, const SquareEye& eye, glm::uvec2 at,
                    PointTile& tile, int place, PointSquare& square, PlaneError& error) = nullptr;
  /// Makes points in float for a tile whose pixels see several receivers; `planes`: of `parts`.
  bool (*see_planes)(const SeenPlane* const* planes, std::span<const ReceiverLanes> parts,
                     const RayRows& rows, const SquareEye& eye, glm::uvec2 at, PointTile& tile, int place,
                     PointSquare& square, PlaneError& error) = nullptr;
  /// Points of that tile. Returns the bits of those that lie inside their triangles; the others are left to
  /// PixelRays::point_on. The operations of the scalar code in the same order, so the same bits.
  std::uint32_t (*see)(const Receiver* receivers, std::span<const ReceiverLanes> parts, const PixelRays& rays,
                       glm::uvec2 at, TilePoints& out) = nullptr;
  /// Points from four rows of positions, `width` apart.
  void (*take)(const glm::dvec3* first, std::size_t width, TilePoints& out) = nullptr;
  /// q from the points of the lanes in `lanes` (not 0), and the box around them as that of tile `place` of a
  /// square.
  void (*fill)(const TilePoints& points, const glm::vec3& base, std::uint32_t lanes, PointTile& tile,
               int place, PointSquare& square) = nullptr;
  /// Lanes of `lanes` (not 0) beyond a gap: farther from the first of them than the others are, by half of
  /// the largest distance.
  std::uint32_t (*beyond_gap)(const PointTile& tile, std::uint32_t lanes) = nullptr;
};
PointTileKernels point_tile_kernels(SimdLevel level);

}  // namespace tenebra::points
