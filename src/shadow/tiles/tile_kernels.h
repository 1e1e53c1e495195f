// What is done to sixteen tiles of points, or to sixteen of the triangles they lie on, before any caster is
// met.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shadow/tiles/ray_forest.h"

namespace tenebra::shadow {

inline constexpr float shortest_ray = 1e-15f, longest_ray = 1e15f;

/// Bits of sixteen triangles.
struct Facing {
  std::uint32_t facing = 0;  ///< the light is on the eye's side for sure
  std::uint32_t open = 0;    ///< to be decided exactly
};

/// Code for one instruction set.
struct TileKernels {
  Facing (*facing)(const points::ReceiverBlock& receivers, const glm::vec3& light) = nullptr;
  /// Boxes of a square's tiles on a face, widened, into `node`, and around those of `tiles` (not 0) into
  /// `all`. False, with nothing of use in them, if not all points of `tiles` are on the face (z >
  /// shortest_ray, within face_limit), or if these tiles are too far apart for a node.
  bool (*project)(const points::PointSquare& square, std::uint32_t tiles, const glm::dvec3& light, int face,
                  RayNode& node, FaceBox& all) = nullptr;
  /// Box of some lanes (not 0) of a tile, from the points themselves; false if they are not all on the face.
  bool (*bound)(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                const glm::dvec3& light, int face, FaceBox& box) = nullptr;
};
TileKernels tile_kernels(SimdLevel level);

}  // namespace tenebra::shadow
