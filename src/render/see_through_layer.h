// What is seen of see-through surfaces: the nearest of them before what is opaque, as samples of their own.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/tint.h>
#include "render/light_tints.h"
#include "shade/shading.h"

namespace tenebra::render {

/// Samples of the nearest see-through surface, and what is left of each light at them. Pixels of the whole
/// picture, as those of the opaque samples.
struct LayerSamples {
  std::vector<std::uint32_t> ids;  ///< no_triangle where nothing see-through stands before what is opaque
  VisiblePoints points;
  std::vector<glm::vec3> normals;
  std::vector<ShadowMask> masks;  ///< of each light; empty of those with an area, and without shadows
  std::vector<std::vector<float>> irradiance;  ///< of each light; empty without an area
  std::vector<LightTint> tints;                ///< of each light
  std::vector<float> openness;                 ///< empty without ambient occlusion

  std::vector<shade::LightFactors> factors() const;
};

/// What passes on the way from what is opaque to the eye: the transmittances of all see-through surfaces
/// between, at the pixels of the layer where it is not 1. By TintTracer, as if the eye were a light, so by
/// exact crossings; in pixels that see nothing opaque, and where the surface of the layer was not crossed (it
/// was seen by the rasteriser's own rule), the transmittance of the layer alone.
class EyeTint {
public:
  void trace(const VisiblePoints& opaque, const LayerSamples& layer, const ViewRays& view,
             const TriangleView& triangles, const SeeThroughSurfaces& surfaces, TintMask& out);

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
  const shade::Subject& subject;
  const shade::Lighting& lighting;
  const shade::PixelSamples& opaque;
  const LayerSamples& layer;
  const SeeThroughSurfaces& surfaces;
  const TintMask& passes;
  shade::Display display;
};
/// `linear`: empty, or gets the same pixels before exposure and tone.
void draw_layer(const LayerPicture& picture, base::Image8& out, base::ImageF& linear);

}  // namespace tenebra::render
