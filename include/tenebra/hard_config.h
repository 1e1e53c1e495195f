// How hard shadows are computed (the light, the variant, the contact rule), and the work that they report.
#pragma once

#include <tenebra/simd_level.h>
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace tenebra {

/// A light without an area. Its shadow rays share their end or, for directional lights, their
/// direction.
struct ShadowLight {
  bool directional = false;       ///< else a point or a spot at `position`
  glm::vec3 position{0.0f};       ///< point and spot: taken as exact
  glm::vec3 to_light{0, 1, 0};    ///< directional: towards the light, taken as exact; any length but zero
  glm::vec3 spot_axis{0, -1, 0};  ///< unit, the way a spot shines
  float spot_cos_outer = -1.0f;   ///< points outside this cone get no ray and mask 0; -1: no cone
  float range_m = 0.0f;           ///< points farther away get no ray and mask 0; 0: unbounded
};

/// How the mask is found: by our own method, or one of the seven variants of the paper's Table 1. All give
/// the same mask; they differ in the work that it takes.
enum class Variant {
  tiles,  ///< tiles of rays against clusters of triangles; precise_sorted takes its place where points are
          ///< less than 1e-15 from the light or more than 1e15 apart
  precise,
  precise_sorted,
  spheres,
  spheres_sorted,
  precise_sea,
  precise_eatp,
  precise_seatp,
};
std::string_view variant_name(Variant variant);  ///< the paper's name: "PreciseSorted"
/// The variant of that name, as variant_name writes it; none if there is no such variant.
std::optional<Variant> variant_from_name(std::string_view name);

/// When a triangle between a point and the light counts as blocking.
enum class ContactRule {
  triangle_ids,  ///< exact: a triangle never blocks its own points, and others' points only if they lie
                 ///< farther behind its plane than the rounding of both triangles' vertices
  none,          ///< always, even the point's own triangle if the point lies behind its plane: for points
                 ///< that do not lie on their triangles, with front-face culling (the paper's method)
};

/// How hard shadows are computed. The mask depends on `cull_front` and `contact` alone.
struct HardShadowConfig {
  Variant variant = Variant::tiles;  ///< the method
  bool cull_front =
      false;  ///< only triangles that face away from the light cast (section 3.6); for closed meshes
  ContactRule contact = ContactRule::triangle_ids;  ///< what decides that a point is dark
  SimdLevel simd = SimdLevel::automatic;            ///< the mask does not depend on it
  bool count_pixel_nodes = false;  ///< fill ShadowTracer::pixel_nodes, for display; the mask is the same
};

/// One value per pixel: 255 where the point sees the light; 0 where it is blocked, faces away or is out of
/// range, or where there is no triangle.
using ShadowMask = std::vector<std::uint8_t>;

/// The work that hard shadows did, summed over the lights. The counts are the same in every run.
struct TraceStats {
  std::uint64_t rays = 0;             ///< shadow rays traced: visible points that the light can reach
  std::uint64_t triangles = 0;        ///< casting triangles of the frame (not summed over the lights)
  std::uint64_t nodes = 0;            ///< tests of a node with a triangle
  std::uint64_t leaf_tests = 0;       ///< tests of a ray with a triangle
  std::uint64_t early_accepts = 0;    ///< nodes found covered by one triangle
  std::uint64_t float_unknown = 0;    ///< pairs among the leaf tests that float left open and that mattered
  std::uint64_t double_unknown = 0;   ///< of these, pairs that double left open too: decided exactly
  std::uint64_t shadowed_pixels = 0;  ///< rays found blocked
  std::uint64_t lit_pixels = 0;       ///< rays found free
  /// Triangles without an area or edge-on to the light, which block nothing. Variant Tiles counts only those
  /// that came near rays or that have equal corners.
  std::uint64_t degenerate_triangles = 0;
  std::uint64_t tree_bytes = 0;    ///< of the cone tree (Tiles: of both trees), for the light that took most
  std::uint64_t lights_tiles = 0;  ///< lights that variant Tiles traced
  std::uint64_t lights_cones = 0;  ///< lights that one of the paper's variants traced
};

/// Adds the work of another light, or of another part of one; for triangles and tree_bytes the larger counts.
inline TraceStats& operator+=(TraceStats& to, const TraceStats& from) {
  to.rays += from.rays;
  to.triangles = std::max(to.triangles, from.triangles);
  to.nodes += from.nodes;
  to.leaf_tests += from.leaf_tests;
  to.early_accepts += from.early_accepts;
  to.float_unknown += from.float_unknown;
  to.double_unknown += from.double_unknown;
  to.shadowed_pixels += from.shadowed_pixels;
  to.lit_pixels += from.lit_pixels;
  to.degenerate_triangles += from.degenerate_triangles;
  to.tree_bytes = std::max(to.tree_bytes, from.tree_bytes);
  to.lights_tiles += from.lights_tiles;
  to.lights_cones += from.lights_cones;
  return to;
}

}  // namespace tenebra
