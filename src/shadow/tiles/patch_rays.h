// From visible points in tiles to ray nodes: one patch of squares after another.
#pragma once

#include <cstdint>
#include <vector>

#include "points/point_tile_kernels.h"
#include "shadow/rays/direction_keys.h"
#include "shadow/rays/shadow_rays.h"
#include "shadow/tiles/ray_forest.h"
#include "shadow/tiles/tile_kernels.h"

namespace tenebra::shadow {

/// Finds the rays of a patch: which points face the light, and where they are on the cube around it. One for
/// all threads.
class PatchRays {
public:
  PatchRays(const VisiblePoints& points, const points::PointTiles& tiles, const TriangleView& triangles,
            const ShadowLight& light, const RaySource& source, const HardShadowConfig& config,
            const DistantFace* distant);

  /// Squares without gaps become nodes as they stand, other groups are loose. Both with keys along the curve.
  void find(const points::PointPatch& patch, ForestScratch::Patch& out) const;

private:
  struct Keys;
  struct Work;

  void find_facing(const points::PointPatch& patch, std::vector<std::uint8_t>& facing) const;
  void prefetch_gaps(const points::PointSquare& square) const;
  void find_lanes(const points::PointSquare& square, Work& work) const;
  std::uint32_t facing_lanes(Work& work, std::uint32_t lanes, std::uint32_t tile) const;
  std::uint32_t lanes_beyond(std::uint32_t lanes, std::uint32_t tile) const;
  Reach reach_of(const points::PointSquare& square) const;
  std::uint32_t in_reach_lanes(const points::PointSquare& square, int tile, std::uint32_t lanes) const;
  glm::dvec3 centre_of(const points::PointSquare& square, int tile) const;
  glm::dvec3 point_of(const points::PointSquare& square, const points::PointTile& tile, int lane) const;
  void place_square(Work& work) const;
  std::uint8_t face_of(const glm::dvec3& p) const;
  bool project(const points::PointSquare& square, std::uint32_t tiles, std::uint8_t face, RayNode& node,
               FaceBox& all) const;
  bool bound(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
             std::uint8_t face, FaceBox& box) const;
  /// Share of the whole face.
  float area(const FaceBox& box) const;
  void add_node(Work& work, std::uint8_t face) const;
  void add_parts(Work& work, int tile) const;
  void add_ray(Work& work, int tile, int lane) const;

  const VisiblePoints& points_;
  const points::PointTiles& tiles_;
  const TriangleView& triangles_;
  const ShadowLight& light_;
  const RaySource& source_;
  const DistantFace* distant_;         ///< null: the cube
  float widest_square_, widest_tile_;  ///< shares of the face
  FacingLight facing_light_;
  points::TilePixels pixels_;
  bool bounded_;  ///< by a cone or a range
  bool smooth_;   ///< points may be lifted
  TileKernels kernels_;
  points::PointTileKernels point_kernels_;
  DirectionKeys direction_keys_;
};

}  // namespace tenebra::shadow
