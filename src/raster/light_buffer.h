// The light buffer: direct diffuse light of one light before shadowing.
#pragma once

#include "base/image.h"
#include "gl/objects.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "scene/frame_geometry.h"
#include "scene/scene.h"

namespace tenebra {

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

private:
  gl::Program program_;
  gl::VertexArray empty_;
};

/// Three channels, row 0 at the top.
void read_light_buffer(const LightBuffer& light_buffer, ImageF& out);

}  // namespace tenebra
