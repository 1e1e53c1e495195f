// The public entry of the hard shadows: visible points, triangles and a light in, a mask out. No OpenGL.
// Olsson and Assarsson 2011, "Improved Ray Hierarchy Alias Free Shadows".
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/frame_timings.h"
#include "points/contact_rule.h"
#include "points/visible_points.h"
#include "scene/frame_geometry.h"
#include "simd/simd_level.h"

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

/// Buffers kept from frame to frame, and what the last mask took.
class ShadowTracer {
public:
  ShadowTracer();
  ShadowTracer(ShadowTracer&&) noexcept;
  ShadowTracer& operator=(ShadowTracer&&) noexcept;
  ~ShadowTracer();

  /// Steps 2 to 4 of the paper's section 3.1 for one light. The mask is the exact answer, the same bits for
  /// any variant (without cull_front), thread count, instruction set and order of the triangles:
  ///
  /// A sample P on triangle R (id) is *active* iff R has an area and light and eye lie strictly on the same
  /// side of R's plane (exact signs; orthographic views: the eye is at infinity against d0), and the spot's
  /// cone and range hold P (these two in double). An active sample is lit unless some casting triangle T =
  /// (A, B, C), T not R, blocks it:
  ///   n = (B-A) x (C-A); s = sign n.(A-L) for a light at L, s = -sign n.l for one towards l; s = 0 blocks
  ///   nothing; edges closed: s ((A-L) x (B-L)).(P-L) >= 0, or s ((B-A) x l).(P-A) >= 0, for AB, BC and CA;
  ///   plane open:   s n.(P-A) > theta, theta = fl64((tau_T + tau_R) |n|), tau_X = sqrt(3) 2^-24 M_X,
  ///                 M_X = largest |coordinate| of triangle X (contact rule `triangle_ids`; else theta = 0).
  /// All signs are of real numbers: floats and the stored doubles are taken as exact.
  void trace_shadow_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                         const ShadowLight& light, const HardShadowConfig& config, ShadowMask& mask);

  const TraceStats& stats() const;  ///< of the last call
  const FrameTimings& timings()
      const;  ///< of the last call: rays_ms, sort_ms, build_ms, traverse_ms, writeback_ms
  /// Of the last call with count_pixel_nodes: node/triangle tests made for each pixel, those of a node shared
  /// equally by the rays below it: they sum up to TraceStats::nodes. 0 without a ray; else empty.
  std::span<const float> pixel_nodes() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
