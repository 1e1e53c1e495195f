// What is seen of see-through surfaces: the nearest of them before what is opaque, as samples of their own.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/tint.h>
#include "render/centres.h"
#include "render/frame_shading.h"
#include "render/lighter.h"
#include "render/lit_samples.h"

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

/// Samples of what is opaque, behind a layer.
struct OpaqueSamples {
  const VisiblePoints& points;  ///< as the eye sees them
  const shade::PixelSamples& lit;
  std::span<const glm::vec2> places;  ///< of samples in the window, pixels; empty: the pixels' centres
};

/// The nearest see-through surface before each sample, lit and shaded as any surface, and what it leaves of
/// the colour behind it: what is opaque times what passes, plus what the nearest surface reflects. Surfaces
/// behind that one let through what they let through, but what they reflect is left out.
class SeeThroughLayer {
public:
  /// Gives their colour to the pixels' centres that see such a surface.
  Expected<void> draw(const Frame& frame, const Centres& centres, Lighter& lighter, FrameShading& shading,
                      io::Image8& picture);

  /// Linear colours of samples, which see triangles `layer` (no_triangle: none) before what is opaque.
  struct Colors {
    std::span<const std::uint32_t>
        samples;                    ///< that a see-through surface has a share in, until the next call
    std::vector<glm::vec3> colors;  ///< of each of them
  };
  Expected<Colors> color(const Frame& frame, std::span<const std::uint32_t> layer, std::size_t count,
                         const OpaqueSamples& opaque, Lighter& lighter, FrameShading& shading);

private:
  Expected<Colors> color(const Frame& frame, LitSamples& layer, const OpaqueSamples& opaque, Lighter& lighter,
                         FrameShading& shading);
  /// The opaque points of the centres: those that shadows start from may be those of the depth buffer, lifted
  /// ones, or none.
  const VisiblePoints& points_behind(const Frame& frame, const Centres& centres);

  LitSamples before_centres_, before_samples_;
  EyeTint eye_tint_;
  TintMask passes_;
  std::vector<std::uint32_t> ids_behind_;
  VisiblePoints behind_;
};

}  // namespace tenebra::render
