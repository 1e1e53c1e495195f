// The public entry of exact soft shadows: visible points, triangles and an area light in; out comes, for each
// pixel, the visible part of the light and its irradiance, without noise. No OpenGL.
// Mora, Aveneau, Apostu and Ghazanfarpour 2012, "Lazy visibility evaluation for exact soft shadows".
#pragma once

#include <tenebra/area_light.h>
#include <tenebra/frame_timings.h>
#include <tenebra/soft_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include <memory>
#include <span>
#include <string>

namespace tenebra {

namespace soft {
struct SolverMakers;
}

/// Computes soft shadows. Keeps its buffers from frame to frame, and the statistics of the last mask.
class SoftShadowTracer {
public:
  SoftShadowTracer();
  /// With solvers in place of the library's own, for tests and measurements.
  explicit SoftShadowTracer(const soft::SolverMakers& solvers);
  SoftShadowTracer(SoftShadowTracer&&) noexcept;
  SoftShadowTracer& operator=(SoftShadowTracer&&) noexcept;
  ~SoftShadowTracer();

  /// Fills `out` with the visible part of `light` from each point, and the irradiance that it sends onto a
  /// surface with the shading normal `normals` (one per pixel, unit; empty: the triangle's face normal on the
  /// point's side).
  ///
  /// A point Q of the light (front side only) is visible from sample P on triangle R iff P lies in front of
  /// the light's plane, Q on the side of R's plane that P is on (visible_side(); strictly), and no casting
  /// triangle T other than R meets the segment PQ with P more than theta off T's plane and P, Q on different
  /// sides of it (theta: the contact rule of hard_shadows.h).
  /// From a sun every P lies in front, and the segments are half-lines.
  /// With TriangleView::normals points of a smooth R may be lifted off it: those that lie off R's plane by
  /// more than theta see Q on both sides of it, and R may block them as any triangle.
  /// visible_fraction is the area of those Q over the light's; irradiance is the integral over them, clamped
  /// to the shading normal's hemisphere. Occluders' lines are computed in double, and polygons on the light
  /// are cut in float, in units of the light: the error is at most 0.1/255 of the unoccluded irradiance
  /// (lights of at least 1e-10 of their distance). With config.error_255 the irradiance of dense penumbrae
  /// may err by that, as estimated (see there). The bits are the same for any number of threads.
  ///
  /// `shown`: what a unit of irradiance makes of light in the picture at each point (fall-off, range, cone);
  /// errors, and the white that they are parts of, are those of irradiance times this. Empty: 1 everywhere.
  ///
  /// Returns false, with `out` unspecified, if `stop` was requested before the end, or for refusal().
  bool trace(const VisiblePoints& points, std::span<const glm::vec3> normals, const TriangleView& triangles,
             const AreaLight& light, const SoftShadowConfig& config, SoftMask& out,
             const StopFlag* stop = nullptr, std::span<const float> shown = {});

  /// Why the last call returned false although no stop was requested, in a sentence; empty if it did not.
  /// Points that are solved together needed more than SoftShadowConfig::memory_bytes.
  const std::string& refusal() const;
  const SoftStats& stats() const;       ///< of the last call
  const FrameTimings& timings() const;  ///< of the last call: shaft_ms, init_ms, query_ms, irradiance_ms

  /// How the last call found each pixel's answer, for display: values of `SoftClass`.
  std::span<const std::uint8_t> classes() const;
  /// For each pixel of the last call, the estimated standard error of its irradiance, in 1/255 of white; 0:
  /// it is exact. Empty with config.error_255 0. SoftStats::error_255 is the root mean square over the
  /// penumbra.
  std::span<const float> errors() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
