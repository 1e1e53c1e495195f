// What is seen of see-through surfaces: the nearest of them before what is opaque, as samples of their own.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/tint.h>
#include "render/frame_shading.h"
#include "render/lit_samples.h"
#include "shade/shading.h"

namespace tenebra::render {

/// What passes on the way from what is opaque to the eye: the transmittances of all see-through surfaces
/// between, at the pixels of the layer where it is not 1. By TintTracer, as if the eye were a light, so by
/// exact crossings; in pixels that see nothing opaque, and where the surface of the layer was not crossed (it
/// was seen by the rasteriser's own rule), the transmittance of the layer alone.
/// False, with `out` unspecified: `stop` was requested before the end.
class EyeTint {
public:
  bool trace(const VisiblePoints& opaque, const LitSamples& layer, const ViewRays& view,
             const TriangleView& triangles, const SeeThroughSurfaces& surfaces, TintMask& out,
             const StopFlag* stop);

private:
  TintTracer tracer_;
  std::vector<std::uint8_t> all_;
  ShadowMask lit_;
  std::vector<std::uint8_t> crossed_;
};

/// Pixels that a see-through surface has a share in, drawn anew: what is opaque times what passes, plus what
/// the nearest surface reflects. Surfaces behind that one let through what they let through, but what they
/// reflect is left out.
struct LayerPicture {
  const TriangleView& triangles;
  const shade::PixelSamples& opaque;
  std::span<const glm::vec2> places;  ///< in the window, by pixel of `opaque`; empty: the pixels' centres
  const LitSamples& layer;
  const SeeThroughSurfaces& surfaces;
  const TintMask& passes;
};
/// Linear colours of the pixels that `passes` names, in their order.
Expected<std::vector<glm::vec3>> layer_colors(const LayerPicture& picture, FrameShading& shading);

}  // namespace tenebra::render
