// Kernels for sixteen tiles of points, or sixteen of the triangles they lie on, that run before any caster is
// met.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shadow/tiles/ray_forest.h"

namespace tenebra::shadow {

inline constexpr float shortest_ray = 1e-15f, longest_ray = 1e15f;

/// Bits of sixteen triangles.
struct Facing {
  std::uint32_t facing = 0;  ///< the light is on the points' side for sure
  std::uint32_t open = 0;    ///< to be decided exactly
};

/// Where the light is as seen from a receiver's corner a: at - scale a of a point; `at` of a directional
/// light. In units in which nothing overflows.
struct FacingLight {
  glm::vec3 at{0.0f};
  float scale = 1;  ///< of corners; 0: directional
};
FacingLight facing_light(const ShadowLight& light);

/// Code for one instruction set.
struct TileKernels {
  Facing (*facing)(const points::ReceiverBlock& receivers, const FacingLight& light) = nullptr;
  /// Boxes of a square's tiles on a face, widened, into `node`, and around those of `tiles` (not 0) into
  /// `all`. False, with nothing of use in them, if not all points of `tiles` are on the face (z >
  /// shortest_ray, within face_limit), or if these tiles are too far apart for a node.
  bool (*project)(const points::PointSquare& square, std::uint32_t tiles, const glm::dvec3& light, int face,
                  RayNode& node, FaceBox& all) = nullptr;
  /// Box of some lanes (not 0) of a tile, from the points themselves; false if they are not all on the face.
  bool (*bound)(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                const glm::dvec3& light, int face, FaceBox& box) = nullptr;
  /// Projects and bounds on the distant face; `project` is false for tiles that are too far apart only.
  bool (*project_distant)(const points::PointSquare& square, std::uint32_t tiles, const DistantFace& face,
                          RayNode& node, FaceBox& all) = nullptr;
  void (*bound_distant)(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                        const DistantFace& face, FaceBox& box) = nullptr;
};
TileKernels tile_kernels(SimdLevel level);

}  // namespace tenebra::shadow
