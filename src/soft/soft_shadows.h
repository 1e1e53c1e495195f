// The public entry of the exact soft shadows: visible points, triangles and an area light in; the visible
// part of the light and its irradiance out, one a pixel, without noise. No OpenGL.
// Mora, Aveneau, Apostu and Ghazanfarpour 2012, "Lazy visibility evaluation for exact soft shadows".
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/frame_timings.h"
#include "parallel/stop_flag.h"
#include "points/visible_points.h"
#include "simd/simd_level.h"
#include "soft/area_light.h"

namespace tenebra {

/// What finds the visible part of the light from the points of a group. All give the same answer.
enum class SoftSolver {
  automatic,  ///< meshes by their outline where enough of their edges cancel, the rest by clipping
  bsp,        ///< the paper's lazily grown BSP of line classes (Algorithm 1)
  clip,       ///< occluders subtracted from the light's polygon, point by point
};
std::string_view soft_solver_name(SoftSolver solver);  ///< "auto", "bsp", "clip"
std::optional<SoftSolver> soft_solver_from_name(std::string_view name);

/// Which points share a BSP.
enum class SoftGrouping {
  neighbourhood,  ///< 8x8 pixels, split where they do not lie together (section 5.5)
  triangle,       ///< all points of a visible triangle (Algorithm 2)
};

/// Which occluder of an undefined leaf is merged next (Algorithm 1, line 31).
enum class OccluderChoice { largest, random };

/// fast: the lines of occluders in double, the polygons that they cut in float, in units of the light.
/// reference: double throughout.
enum class SoftPrecision { fast, reference };

struct SoftShadowConfig {
  SoftSolver solver = SoftSolver::automatic;
  SoftGrouping grouping = SoftGrouping::neighbourhood;
  OccluderChoice choice = OccluderChoice::largest;
  SoftPrecision precision = SoftPrecision::fast;
  bool keep_trees = true;  ///< false: each query starts anew (the paper's "modified version", Figure 8)
  SimdLevel simd = SimdLevel::automatic;
};

/// One a pixel, row 0 at the top; zero where no triangle is seen or the light is below the horizon.
struct SoftMask {
  std::vector<float> visible_fraction;  ///< 0..1: visible area over area of the light
  std::vector<float> irradiance;        ///< 0..pi: for radiance 1, W/m2; the integral of cos over the visible
                                        ///< part's solid angle
};

/// Buffers kept from frame to frame, and what the last mask took.
class SoftShadowTracer {
public:
  SoftShadowTracer();
  SoftShadowTracer(SoftShadowTracer&&) noexcept;
  SoftShadowTracer& operator=(SoftShadowTracer&&) noexcept;
  ~SoftShadowTracer();

  /// The visible part of `light` from each point, and the irradiance it sends onto a surface with the shading
  /// normal `normals` (one a pixel, unit; empty: the triangle's face normal on the view's side).
  ///
  /// A point Q of the light (front side only) is visible from sample P on triangle R iff P lies in front of
  /// the light's plane, Q on the side of R's plane from which the view sees R (strictly), and no casting
  /// triangle T other than R meets the segment PQ with P more than theta off T's plane and P, Q on different
  /// sides of it (theta: the contact rule of points/contact_rule.h, the same as for hard shadows).
  /// visible_fraction is the area of those Q over the light's; irradiance is the integral over them, clamped
  /// to the shading normal's hemisphere. Errors: `reference` 1e-6 of the fraction, or 2^-48 of the distance
  /// over the light's size if that is more; `fast` 0.1/255 of the unoccluded irradiance (lights of at least
  /// 1e-10 of their distance). The same bits for any thread count.
  ///
  /// Returns false, with `out` unspecified, if `stop` was requested before the end.
  bool trace(const VisiblePoints& points, std::span<const glm::vec3> normals, const ViewRays& view,
             const TriangleView& triangles, const AreaLight& light, const SoftShadowConfig& config,
             SoftMask& out, const StopFlag* stop = nullptr);

  const SoftStats& stats() const;       ///< of the last call
  const FrameTimings& timings() const;  ///< of the last call: shaft_ms, init_ms, query_ms, irradiance_ms

  /// How the last call classified and solved each pixel, for display: one of `SoftClass`.
  std::span<const std::uint8_t> classes() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

enum class SoftClass : std::uint8_t { background, below_horizon, lit, dark, bsp, clip, outline };

}  // namespace tenebra
