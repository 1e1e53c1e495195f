// The light buffer: direct diffuse light of one light before shadowing.
#pragma once

#include <optional>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include "base/image.h"
#include "gl/objects.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"

namespace tenebra::raster {

struct LightBuffer {
  gl::Texture light;  ///< linear RGB, 32-bit floats; 0 where no triangle is seen
  gl::Framebuffer framebuffer;
};

class LightPass {
public:
  static Expected<LightPass> create();

  /// Light that `light`, placed by `placed`, would send from the seen triangles to the eye if nothing were in
  /// between. Zero where light and eye lie on different sides of the triangle's plane; the shading normal is
  /// turned to the eye's side. With albedo c, distance d, angle theta at the surface:
  /// - Falloff::inverse_square, photometric: c / pi * I cos(theta) / d^2; directional: c / pi * E cos(theta).
  ///   Range and cones fade as in KHR_lights_punctual. Area lights act as their centre: I = nits * area *
  ///   cos(angle from their axis), nothing behind them.
  /// - Falloff::none, no unit (BART): c * I cos(theta).
  /// Done when it returns.
  Expected<void> draw(const GBuffer& gbuffer, const GeometryBuffers& geometry, const Light& light,
                      const WorldLight& placed, LightBuffer& out) const;

  /// The same of a light with an area, for each unit of the irradiance that light of radiance 1 sends to a
  /// point: c / pi * L, with L = nits of an area light, I / area_m2 of the others. Falloff::none: c * I d^2 /
  /// area_m2 with the distance d to the light's centre, which a small light's irradiance, area cos cos' /
  /// d^2, makes c * I cos(theta) cos' again. Range and a spot's cone fade as seen from the light's centre.
  Expected<void> draw_area(const GBuffer& gbuffer, const GeometryBuffers& geometry, const Light& light,
                           const WorldLight& placed, double area_m2, LightBuffer& out) const;

private:
  Expected<void> draw(const GBuffer& gbuffer, const GeometryBuffers& geometry, const Light& light,
                      const WorldLight& placed, std::optional<double> area_m2, LightBuffer& out) const;

  gl::Program program_;
  gl::VertexArray empty_;
};

/// Three channels, row 0 at the top.
void read_light_buffer(const LightBuffer& light_buffer, base::ImageF& out);

}  // namespace tenebra::raster
