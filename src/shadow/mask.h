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
#include "scene/frame_geometry.h"

namespace tenebra {

/// Id of a pixel where no triangle is seen.
inline constexpr std::uint32_t no_triangle = 0xffffffffu;

/// Triangles of one instant: float vertices, taken as exact. Receivers and occluders alike, known by their
/// index.
struct TriangleView {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;
  std::span<const std::uint8_t> casts_shadow;  ///< one a triangle; empty: all cast
};

/// What the rays of a light share: their end (point and spot lights) or their direction (directional lights).
struct ShadowLight {
  bool directional = false;
  glm::vec3 position{0.0f};       ///< point and spot: taken as exact
  glm::vec3 to_light{0, 1, 0};    ///< directional: towards the light, taken as exact; any length but zero
  glm::vec3 spot_axis{0, -1, 0};  ///< unit, the way a spot shines
  float spot_cos_outer = -1.0f;   ///< points outside this cone get no ray and mask 0; -1: no cone
  float range_m = 0.0f;           ///< points farther away get no ray and mask 0; 0: unbounded
};

/// Samples, one a pixel, row 0 at the top: a point, taken as exact, and the triangle it lies on.
struct VisiblePoints {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec3> positions;     ///< width * height; meaningless where the id is no_triangle
  std::vector<std::uint32_t> triangles;  ///< width * height ids, or no_triangle
};

/// Points where the pixels' rays meet the planes of their triangles, in double, clamped into the triangle
/// (a rasteriser's id may lie just outside). `ids`: width * height, row 0 at the top; ids out of range count
/// as no_triangle. Bits do not depend on threads or instruction set.
void compute_visible_points(std::span<const std::uint32_t> ids, int width, int height, const ViewRays& view,
                            const TriangleView& triangles, VisiblePoints& out);

/// The seven variants of the paper's Table 1. All give the same mask; they differ in the work they need.
enum class Variant {
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

enum class SimdLevel { automatic, scalar, sse4, avx2, avx512 };
std::string_view simd_level_name(SimdLevel level);
std::optional<SimdLevel> simd_level_from_name(std::string_view name);
bool simd_level_supported(SimdLevel level);  ///< by this build on this machine
SimdLevel best_simd_level();                 ///< what `automatic` means here

/// What decides that a point does not see the light.
enum class ContactRule {
  triangle_ids,  ///< exact: the own triangle never blocks, others block beyond the rounding of both
                 ///< triangles' vertices
  none,  ///< every triangle in between blocks: for points without ids, with front-face culling (the paper's
         ///< way)
};

struct HardShadowConfig {
  Variant variant = Variant::precise_sorted;
  bool cull_front =
      false;  ///< section 3.6: only triangles that face away from the light cast (closed meshes only)
  ContactRule contact = ContactRule::triangle_ids;
  SimdLevel simd = SimdLevel::automatic;
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

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// theta of the contact rule, in double and by these operations (the definition above).
double contact_threshold(const glm::vec3 occluder[3], double tau_occluder, double tau_receiver);
double rounding_tolerance(const glm::vec3 triangle[3]);  ///< tau_X

}  // namespace tenebra
