// How much of each light reaches samples, the pixels' centres like all others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tenebra/ambient_occlusion.h>
#include <tenebra/hard_shadows.h>
#include <tenebra/soft_shadows.h>
#include <tenebra/tint.h>
#include "render/frame.h"
#include "render/light_points.h"
#include "render/lit_samples.h"

namespace tenebra::render {

/// Which lights samples are lit by.
enum class LightKinds {
  all,     ///< all of them, and ambient occlusion
  points,  ///< those without an area
  masks,   ///< the same, but not what see-through surfaces let pass
  areas    ///< those with an area, and ambient occlusion
};

/// Every call of a tracer of shadows, tints and occlusion is here. Keeps the tracers, and with them what they
/// have made of a frame's triangles: light the centres first in each frame. All functions fail with
/// "stopped", or with the sentence of a tracer.
class Lighter {
public:
  /// Lights the pixels' centres by all lights and, in `result`, fills counts, times, notes and of each
  /// light's mask what is there to look at: all but `mask`, `visible_fraction` and `tint`, which are in `at`.
  Expected<void> light_centres(const Frame& frame, const AoProgress& progress, LitSamples& at,
                               FrameResult& result);
  /// Lights further samples whose points (for areas and occlusion: and normals) are known, lifted first where
  /// the settings say so.
  Expected<void> light(const Frame& frame, LightKinds kinds, LitSamples& at);

  /// Names a change of the solver that the bound on memory made necessary in this frame.
  void note_changed_groups(const SoftShadowConfig& config, std::vector<std::string>& notes) const;

private:
  /// Where counts go, and what a mask has to look at; null: nobody asked.
  struct Told {
    FrameResult* result = nullptr;
    LightMask* mask = nullptr;
  };
  Expected<void> occlude(const Frame& frame, const AoProgress& progress, LitSamples& at, FrameResult* told);
  /// A light as a point or a direction.
  Expected<void> trace_point(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                             SampleLight& out, Told told);
  /// A light as a polygon; one that shines alike in every direction (soft/light/even_emission.h) by both
  /// sides.
  Expected<void> trace_area(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                            SampleLight& out, Told told);
  Expected<void> trace_side(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                            SampleLight& out, Told told);
  Expected<void> trace_visible_part(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                    SoftMask& out, FrameResult* told);
  /// Of the samples that `out` says are lit.
  Expected<void> trace_tint(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                            SampleLight& out);
  /// Receivers and casters of one light, with normals where points are lifted. Valid until the next call.
  TriangleView traced_triangles(const Frame& frame, const DrawnLight& light);

  ShadowTracer hard_;
  SoftShadowTracer soft_;
  LightPointShadows light_points_;
  TintTracer tint_;
  AmbientOcclusion ambient_;
  std::vector<std::uint8_t> casters_;
  SampleLight behind_;              // the other side of an area light
  LightMask behind_mask_;           // and what there is to look at
  std::vector<float> shown_;        // of a light with an area: what the sampler weighs errors by
  bool tint_has_surfaces_ = false;  // of this frame
  bool groups_changed_ = false;     // in this frame: SoftStats::groups_changed
};

}  // namespace tenebra::render
