// The picture: ambient and emitted light plus the light buffers where their masks let them through.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "base/image.h"
#include "gl/objects.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "raster/light_buffer.h"

namespace tenebra::raster {

struct CompositeSettings {
  glm::vec3 ambient_light{1.0f};
  glm::vec3 background{0.0f};       ///< linear, where no triangle is seen
  float exposure = 1.0f;            ///< factor of all linear colour, background too
  std::span<const float> openness;  ///< ambient occlusion, 1 open .. 0 closed, one per pixel; empty: all open
};

/// begin, add_light or add_area_light for each light, finish: once per frame, in this order.
class Compositor {
public:
  static Expected<Compositor> create();

  Expected<void> begin(int width, int height);
  /// Adds light x mask / 255. `mask`: width * height, row 0 at the top; empty: all lit.
  void add_light(const LightBuffer& light, std::span<const std::uint8_t> mask);
  /// Adds light x irradiance, for a buffer of LightPass::draw_area. `irradiance`: as `mask` above.
  void add_area_light(const LightBuffer& light, std::span<const float> irradiance);
  /// (ambient x ambient_light x openness + emissive + sum of lights) x exposure, clamped, as sRGB: within one
  /// level's rounding of the formula. `out` keeps its capacity.
  void finish(const GBuffer& gbuffer, const GeometryBuffers& geometry, const CompositeSettings& settings,
              base::Image8& out);

private:
  void accumulate(const LightBuffer& light, const gl::Texture* factor);

  gl::Program accumulate_program_, composite_program_;
  gl::VertexArray empty_;
  gl::Texture sum_, mask_, factor_, picture_;
  gl::Framebuffer sum_framebuffer_, picture_framebuffer_;
  std::vector<std::uint8_t> rgba_;
};

}  // namespace tenebra::raster
