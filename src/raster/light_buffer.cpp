#include "raster/light_buffer.h"

#include <embedded_shaders.h>
#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "raster/passes.h"

namespace tenebra::raster {
namespace {

// Uniform locations of shaders/light.frag; 0 to 4 are those of shaders/view.glsl.
enum Location : GLint {
  d0 = 0,
  dx = 1,
  dy = 2,
  near_far = 3,
  orthographic = 4,
  light_from_eye = 5,
  light_direction = 6,
  light_color = 7,
  cone = 8,
  range = 9,
  directional = 10,
  distance_power = 11,
  cosine_emitter = 12,
  by_irradiance = 13,
};

bool is_area(LightType type) {
  return type == LightType::area_rect || type == LightType::area_disk;
}

/// Intensity on the axis (with `area_m2`: radiance) times color, and 1/pi of the diffuse reflection for
/// lights with units.
glm::vec3 scaled_color(const Light& light, const WorldLight& placed, std::optional<double> area_m2) {
  glm::vec3 color = light.color * light.intensity;
  const float half_area = glm::length(glm::cross(placed.axis_x, placed.axis_y));
  if (area_m2) {
    if (!is_area(light.type)) color /= static_cast<float>(*area_m2);
  } else if (is_area(light.type)) {
    color *= (light.type == LightType::area_rect ? 4.0f : glm::pi<float>()) * half_area;
  }
  return light.falloff == Falloff::inverse_square ? color / glm::pi<float>() : color;
}

/// What the distance is raised to.
int power_of_distance(const Light& light, bool by_irradiance) {
  if (light.type == LightType::directional) return 0;
  const int of_point = light.falloff == Falloff::inverse_square ? -2 : 0;
  return by_irradiance ? of_point + 2 : of_point;  // irradiance falls off by itself
}

/// Scale and offset of the cosine, as KHR_lights_punctual gives them; other lights: 1 everywhere.
glm::vec2 cone_fade(const Light& light) {
  if (light.type != LightType::spot) return {0.0f, 1.0f};
  constexpr float min_width = 0.001f;  // the extension's
  const float cos_outer = std::cos(light.outer_cone_rad);
  const float scale = 1.0f / std::max(min_width, std::cos(light.inner_cone_rad) - cos_outer);
  return {scale, -cos_outer * scale};
}

void set_view(const GBuffer& gbuffer) {
  const ViewRays& view = gbuffer.view;
  glUniform3fv(d0, 1, glm::value_ptr(view.d0));
  glUniform3fv(dx, 1, glm::value_ptr(view.dx));
  glUniform3fv(dy, 1, glm::value_ptr(view.dy));
  glUniform2f(near_far, gbuffer.transform.near_t, gbuffer.transform.far_t);
  glUniform1i(orthographic, view.orthographic);
}

void set_light(const GBuffer& gbuffer, const Light& light, const WorldLight& placed,
               std::optional<double> area_m2) {
  const bool is_directional = light.type == LightType::directional;
  // Relative to the eye: far from the world's origin absolute floats are coarse.
  const glm::vec3 from_eye = placed.position - gbuffer.view.eye;
  glUniform3fv(light_from_eye, 1, glm::value_ptr(from_eye));
  glUniform3fv(light_direction, 1, glm::value_ptr(placed.direction));
  glUniform3fv(light_color, 1, glm::value_ptr(scaled_color(light, placed, area_m2)));
  glUniform2fv(cone, 1, glm::value_ptr(cone_fade(light)));
  glUniform1f(range, light.range_m.value_or(0.0f));
  glUniform1i(directional, is_directional);
  glUniform1i(distance_power, power_of_distance(light, area_m2.has_value()));
  glUniform1i(cosine_emitter, is_area(light.type) && !area_m2);
  glUniform1i(by_irradiance, area_m2.has_value());
}

Expected<void> make_target(int width, int height, LightBuffer& out) {
  if (out.framebuffer && out.light.width() == width && out.light.height() == height) return {};
  auto light = gl::Texture::create(gl::PixelFormat::rgba32f, width, height);
  if (!light) return tl::unexpected(std::move(light.error()));
  auto framebuffer = gl::Framebuffer::create({&*light});
  if (!framebuffer) return tl::unexpected(std::move(framebuffer.error()));
  out.light = std::move(*light);
  out.framebuffer = std::move(*framebuffer);
  return {};
}

}  // namespace

Expected<LightPass> LightPass::create() {
  auto program = gl::Program::build(
      "light", {shaders::fullscreen_vert},
      {shaders::triangles_glsl, shaders::normals_glsl, shaders::view_glsl, shaders::light_frag});
  if (!program) return tl::unexpected(std::move(program.error()));
  LightPass pass;
  pass.program_ = std::move(*program);
  pass.empty_ = gl::VertexArray::create();
  return pass;
}

Expected<void> LightPass::draw(const GBuffer& gbuffer, const GeometryBuffers& geometry, const Light& light,
                               const WorldLight& placed, LightBuffer& out) const {
  return draw(gbuffer, geometry, light, placed, std::nullopt, out);
}

Expected<void> LightPass::draw_area(const GBuffer& gbuffer, const GeometryBuffers& geometry,
                                    const Light& light, const WorldLight& placed, double area_m2,
                                    LightBuffer& out) const {
  return draw(gbuffer, geometry, light, placed, std::optional(area_m2), out);
}

Expected<void> LightPass::draw(const GBuffer& gbuffer, const GeometryBuffers& geometry, const Light& light,
                               const WorldLight& placed, std::optional<double> area_m2,
                               LightBuffer& out) const {
  if (auto made = make_target(gbuffer.width, gbuffer.height, out); !made) return made;
  begin_pass(out.framebuffer, program_, gbuffer.width, gbuffer.height);
  geometry.bind_records();
  bind_texture(0, gbuffer.ids);
  bind_texture(1, gbuffer.normals);
  bind_texture(2, gbuffer.depth);
  set_view(gbuffer);
  set_light(gbuffer, light, placed, area_m2);
  draw_fullscreen(empty_);
  end_pass();
  return {};
}

void read_light_buffer(const LightBuffer& light_buffer, base::ImageF& out) {
  const int width = light_buffer.light.width(), height = light_buffer.light.height();
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<glm::vec4> texels(count);
  light_buffer.light.read(std::as_writable_bytes(std::span(texels)));
  out.width = width;
  out.height = height;
  out.channels = 3;
  out.pixels.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) out.pixels[3 * i + static_cast<std::size_t>(c)] = texels[i][c];
  }
}

}  // namespace tenebra::raster
