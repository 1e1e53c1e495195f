// What hard shadows are asked for: the light, the variant of the method, the contact rule; and the work that
// they report.
#pragma once

#include <tenebra/simd_level.h>
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace tenebra {

/// What the rays of a light share: their end (point and spot lights) or their direction (directional lights).
struct ShadowLight {
  bool directional = false;
  glm::vec3 position{0.0f};       ///< point and spot: taken as exact
  glm::vec3 to_light{0, 1, 0};    ///< directional: towards the light, taken as exact; any length but zero
  glm::vec3 spot_axis{0, -1, 0};  ///< unit, the way a spot shines
  float spot_cos_outer = -1.0f;   ///< points outside this cone get no ray and mask 0; -1: no cone
  float range_m = 0.0f;           ///< points farther away get no ray and mask 0; 0: unbounded
};

/// Ours, and the seven variants of the paper's Table 1. All give the same mask; they differ in the work they
/// need.
enum class Variant {
  tiles,  ///< tiles of rays against clusters of triangles (tiles/tile_tracer.h); where it does not apply,
          ///< precise_sorted
  precise,
  precise_sorted,
  spheres,
  spheres_sorted,
  precise_sea,
  precise_eatp,
  precise_seatp,
};
std::string_view variant_name(Variant variant);  ///< the paper's name: "PreciseSorted"
std::optional<Variant> variant_from_name(std::string_view name);

/// What decides that a point does not see the light.
enum class ContactRule {
  triangle_ids,  ///< exact: the own triangle never blocks, others block beyond the rounding of both
                 ///< triangles' vertices
  none,  ///< every triangle in between blocks: for points without ids, with front-face culling (the paper's
         ///< way)
};

struct HardShadowConfig {
  Variant variant = Variant::tiles;
  bool cull_front =
      false;  ///< section 3.6: only triangles that face away from the light cast (closed meshes only)
  ContactRule contact = ContactRule::triangle_ids;
  SimdLevel simd = SimdLevel::automatic;
  bool count_pixel_nodes = false;  ///< fill ShadowTracer::pixel_nodes, for display; the mask is the same
};

/// One a pixel: 255 the point sees the light; 0 blocked, facing away, out of reach, or no triangle.
using ShadowMask = std::vector<std::uint8_t>;

/// Work counted by the tracer of shadow rays, summed over the lights. Counts do not jitter.
struct TraceStats {
  std::uint64_t rays = 0;            ///< shadow rays traced: visible points that the light can reach
  std::uint64_t triangles = 0;       ///< casting triangles of the frame (not summed over the lights)
  std::uint64_t nodes = 0;           ///< node/triangle tests
  std::uint64_t leaf_tests = 0;      ///< ray/triangle tests
  std::uint64_t early_accepts = 0;   ///< nodes found covered by one triangle
  std::uint64_t float_unknown = 0;   ///< ray/triangle pairs that the float filter left open and that mattered
  std::uint64_t double_unknown = 0;  ///< of these, pairs that double precision left open: decided exactly
  std::uint64_t shadowed_pixels = 0;       ///< rays found blocked
  std::uint64_t lit_pixels = 0;            ///< rays found free
  std::uint64_t degenerate_triangles = 0;  ///< zero area or edge-on to the light: they block nothing. Variant
                                           ///< Tiles: of those that came near rays, or have equal corners
  std::uint64_t tree_bytes = 0;  ///< memory of the cone tree (Tiles: of both trees), largest of the lights
};

/// Adds the work of another light, or of another part of one (triangles, tree_bytes: the larger).
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
  return to;
}

}  // namespace tenebra
