// The public entry of hard shadows: visible points, triangles and a light in, a mask out. No OpenGL.
// Olsson and Assarsson 2011, "Improved Ray Hierarchy Alias Free Shadows".
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include <memory>
#include <span>

namespace tenebra {

/// Computes hard shadows. Keeps its buffers from frame to frame, and the statistics of the last mask.
class ShadowTracer {
public:
  ShadowTracer();
  ShadowTracer(ShadowTracer&&) noexcept;
  ShadowTracer& operator=(ShadowTracer&&) noexcept;
  ~ShadowTracer();

  /// Fills `mask` for one light (steps 2 to 4 of the paper's section 3.1). The mask is the exact answer, the
  /// same bits for any variant (without cull_front), number of threads, instruction set and order of the
  /// triangles:
  ///
  /// A sample P on triangle R (id) is *active* iff R has an area and the light lies strictly on the sample's
  /// side of R's plane (visible_side(); exact signs), and the spot's cone and range hold P (these two in
  /// double). An active sample is lit unless some casting triangle T =
  /// (A, B, C), T not R (with contact rule `none` R too), blocks it:
  ///   n = (B-A) x (C-A); s = sign n.(A-L) for a light at L, s = -sign n.l for one towards l; s = 0 blocks
  ///   nothing; edges closed: s ((A-L) x (B-L)).(P-L) >= 0, or s ((B-A) x l).(P-A) >= 0, for AB, BC and CA;
  ///   plane open:   s n.(P-A) > theta, theta = fl64((tau_T + tau_R) |n|), tau_X = sqrt(3) 2^-24 M_X,
  ///                 M_X = largest |coordinate| of triangle X (contact rule `triangle_ids`; else theta = 0).
  /// All signs are of real numbers: floats and the stored doubles are taken as exact.
  ///
  /// With TriangleView::normals points may be lifted off R (lift_visible_points), and then light may reach
  /// them from beyond R's plane: a sample on a smooth R with the light not strictly on its side is
  /// active all the same iff the light is before the plane at one of R's vertices (A, N), N.(L-A) > 0 or
  /// N.l > 0, N turned to the sample's side (in double); P lies off R's plane on its side,
  /// |n.(P-A)| > theta with T = R; and the way from P to the light does not meet R (edges closed). So R
  /// itself blocks lifted points as any triangle would. The mask stays exact; only the point that it is asked
  /// about has moved. It does not say whether the shading normal faces the light; shading decides that.
  ///
  /// Returns false, with `mask` unspecified, if `stop` was requested before the end.
  bool trace_shadow_mask(const VisiblePoints& points, const TriangleView& triangles, const ShadowLight& light,
                         const HardShadowConfig& config, ShadowMask& mask, const StopFlag* stop = nullptr);

  const TraceStats& stats() const;  ///< of the last call
  /// The method that ran in the last call: HardShadowConfig::variant, or what took its place.
  Variant ran() const;
  /// Times of the last call: rays_ms, sort_ms, build_ms, traverse_ms, writeback_ms.
  const FrameTimings& timings() const;
  /// After a call with count_pixel_nodes (else empty): how many node tests were made for each pixel, 0
  /// where there was no ray. A node's tests are divided equally among the rays below it, so that the sum is
  /// TraceStats::nodes.
  std::span<const float> pixel_nodes() const;

  /// From now on both tracers use the other's tree over the triangles, of which each has one of its own else.
  /// Then masks of the same triangles can be traced by both at the same time once follow() has been called
  /// for one of them.
  void share_triangles(ShadowTracer& other);
  /// Does what the next trace_shadow_mask() of these triangles does first: makes the tree over them, or moves
  /// the last frame's, while no other tracer that shares it is at work. With TriangleView::version not 0 that
  /// call finds it done. Returns false if `stop` was requested before the end.
  bool follow(const TriangleView& triangles, SimdLevel simd, const StopFlag* stop = nullptr);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
