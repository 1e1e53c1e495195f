// What is done to the sixteen points of a tile before any triangle is met.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shadow/tiles/ray_forest.h"

namespace tenebra {

/// Points of a tile relative to the light, rounded to float; lanes without a ray hold the tile's base.
struct TilePoints {
  alignas(64) float x[tile_rays], y[tile_rays], z[tile_rays];
};

/// Code for one instruction set.
struct TileKernels {
  /// Fills q, base, radius, reach, live and rays of `tile` for the lanes in `lanes` (not 0). rows[k] points
  /// to the four points of row k, of which those in `lanes` are read as numbers. True if one of them may be
  /// the light itself.
  bool (*load)(const glm::dvec3* const rows[4], const glm::dvec3& origin, std::uint32_t lanes, RayTile& tile,
               TilePoints& points) = nullptr;
  /// Lanes of `tile` beyond a gap: farther from its first ray than the others by half of the tile's extent.
  std::uint32_t (*beyond_gap)(const RayTile& tile) = nullptr;
  /// Box on a face, widened; false if a point is off the face (z <= 0 or beyond face_limit).
  bool (*bound)(const TilePoints& points, int face, FaceBox& box) = nullptr;
};
TileKernels tile_kernels(SimdLevel level);

}  // namespace tenebra
