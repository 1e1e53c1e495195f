// Trees over triangles, and a caster of single rays through them (fan_caster.h has one for many,
// shaft_search.h finds what lies in a shaft). Eight boxes or eight triangles are met at once.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <tenebra/simd_level.h>
#include <tenebra/stop_flag.h>
#include "math/box.h"
#include "trees/ray_batch.h"

namespace tenebra::trees {

inline constexpr int bvh_width = 8;
inline constexpr int bvh_depth = 64;  ///< levels at most
inline constexpr std::uint32_t no_caster = 0xffffffffu;

/// Boxes of up to eight children. A child is a node, or with `bvh_leaf` set a block; `bvh_no_child` has a box
/// that no ray meets.
inline constexpr std::uint32_t bvh_leaf = 0x80000000u, bvh_no_child = 0xffffffffu;
struct alignas(64) BvhNode {
  float plane[6][bvh_width];  ///< low x, y, z, high x, y, z
  std::uint32_t child[bvh_width];
};

/// Up to eight triangles; the places left over hold a triangle without area, which no ray meets.
struct alignas(64) BvhTriangles {
  float corner[3][3][bvh_width];  ///< [corner][axis][triangle]
  std::uint32_t triangle[bvh_width];
};

struct TriangleBvh {
  std::vector<BvhNode> nodes;  ///< the first is the root, children lie behind their node; empty: no triangles
  std::vector<BvhTriangles> blocks;
  std::size_t triangles = 0;  ///< in the tree

  math::Box<float> box() const;  ///< of all triangles

  std::size_t bytes() const { return nodes.size() * sizeof(BvhNode) + blocks.size() * sizeof(BvhTriangles); }
};

/// Which triangles a tree holds. No tree holds one with an index out of range, or with a coordinate that is
/// not finite or beyond 1e18.
enum class BvhHolds {
  with_area,  ///< those that a ray can meet
  all,        ///< flat ones, too, which may have an area once they have moved
};

/// Binned surface-area heuristic, eight children to a node; of triangles with an area. The same tree on every
/// machine, for any number of threads.
TriangleBvh build_triangle_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);
/// The same; none if `stop` was requested, which is looked at every few thousand triangles.
std::optional<TriangleBvh> build_triangle_bvh(std::span<const glm::vec3> positions,
                                              std::span<const glm::uvec3> triangles, const StopFlag* stop,
                                              BvhHolds holds = BvhHolds::with_area);

/// Puts corners and boxes where the triangles are now; what lies together stays together.
void refit_triangle_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                        TriangleBvh& bvh);

/// One ray; hits with from < t < to count, on either side of a triangle. A triangle never hides its own
/// points: `skip` names the one that the origin lies on.
struct CasterRay {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};
  float from = 0;
  float to = std::numeric_limits<float>::infinity();
  std::uint32_t skip = no_caster;
};

struct CasterHit {
  float distance = std::numeric_limits<float>::infinity();  ///< t of the nearest hit; infinity: none
  std::uint32_t triangle = no_caster;                       ///< the smallest id among the nearest
};

/// Code for one instruction set. Bits do not depend on it. Rays that are not finite meet nothing. Two
/// triangles that share an edge leave no gap between them.
struct BvhKernels {
  CasterHit (*closest)(const TriangleBvh&, const CasterRay&) = nullptr;
  bool (*any)(const TriangleBvh&, const CasterRay&) = nullptr;
  /// distance[i] = t of the nearest hit of ray i before distance[i]; else left as it is. One ray after the
  /// other.
  void (*closest_batch)(const TriangleBvh&, const RayBatch&, float* distance) = nullptr;
};
BvhKernels bvh_kernels(SimdLevel level);

}  // namespace tenebra::trees
