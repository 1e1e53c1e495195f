#include "raster/composite.h"

#include <embedded_shaders.h>
#include <glad/gl.h>

#include <cassert>
#include <glm/gtc/type_ptr.hpp>

#include "raster/passes.h"

namespace tenebra::raster {
namespace {

constexpr int use_factor_location = 0;  // of accumulate.frag
constexpr int ambient_location = 0, background_location = 1, exposure_location = 2,
              use_openness_location = 3;  // of composite.frag

}  // namespace

Expected<Compositor> Compositor::create() {
  auto accumulate = gl::Program::build("accumulate", {shaders::fullscreen_vert}, {shaders::accumulate_frag});
  if (!accumulate) return tl::unexpected(std::move(accumulate.error()));
  auto composite = gl::Program::build("composite", {shaders::fullscreen_vert},
                                      {shaders::triangles_glsl, shaders::composite_frag});
  if (!composite) return tl::unexpected(std::move(composite.error()));
  Compositor compositor;
  compositor.accumulate_program_ = std::move(*accumulate);
  compositor.composite_program_ = std::move(*composite);
  compositor.empty_ = gl::VertexArray::create();
  return compositor;
}

Expected<void> Compositor::begin(int width, int height) {
  if (!picture_framebuffer_ || sum_.width() != width || sum_.height() != height) {
    auto sum = gl::Texture::create(gl::PixelFormat::rgba32f, width, height);
    auto mask = gl::Texture::create(gl::PixelFormat::r8, width, height);
    auto factor = gl::Texture::create(gl::PixelFormat::r32f, width, height);
    auto picture = gl::Texture::create(gl::PixelFormat::rgba8, width, height);
    for (auto* target : {&sum, &mask, &factor, &picture}) {
      if (!*target) return tl::unexpected(std::move(target->error()));
    }
    auto sum_framebuffer = gl::Framebuffer::create({&*sum});
    auto picture_framebuffer = gl::Framebuffer::create({&*picture});
    for (auto* framebuffer : {&sum_framebuffer, &picture_framebuffer}) {
      if (!*framebuffer) return tl::unexpected(std::move(framebuffer->error()));
    }
    sum_ = std::move(*sum);
    mask_ = std::move(*mask);
    factor_ = std::move(*factor);
    picture_ = std::move(*picture);
    sum_framebuffer_ = std::move(*sum_framebuffer);
    picture_framebuffer_ = std::move(*picture_framebuffer);
  }
  const GLfloat dark[4] = {};
  glClearNamedFramebufferfv(sum_framebuffer_.name(), GL_COLOR, 0, dark);
  return {};
}

void Compositor::add_light(const LightBuffer& light, std::span<const std::uint8_t> mask) {
  if (!mask.empty()) mask_.upload(std::as_bytes(mask));
  accumulate(light, mask.empty() ? nullptr : &mask_);
}

void Compositor::add_area_light(const LightBuffer& light, std::span<const float> irradiance) {
  factor_.upload(std::as_bytes(irradiance));
  accumulate(light, &factor_);
}

void Compositor::accumulate(const LightBuffer& light, const gl::Texture* factor) {
  assert(light.light.width() == sum_.width() && light.light.height() == sum_.height());
  begin_pass(sum_framebuffer_, accumulate_program_, sum_.width(), sum_.height());
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  bind_texture(0, light.light);
  bind_texture(1, factor != nullptr ? *factor : mask_);
  glUniform1i(use_factor_location, factor != nullptr);
  draw_fullscreen(empty_);
  glDisable(GL_BLEND);
  end_pass();
}

void Compositor::finish(const GBuffer& gbuffer, const GeometryBuffers& geometry,
                        const CompositeSettings& settings, base::Image8& out) {
  assert(gbuffer.width == sum_.width() && gbuffer.height == sum_.height());
  if (!settings.openness.empty()) factor_.upload(std::as_bytes(settings.openness));
  begin_pass(picture_framebuffer_, composite_program_, gbuffer.width, gbuffer.height);
  geometry.bind_records();
  bind_texture(0, gbuffer.ids);
  bind_texture(1, sum_);
  bind_texture(2, factor_);
  glUniform3fv(ambient_location, 1, glm::value_ptr(settings.ambient_light));
  glUniform3fv(background_location, 1, glm::value_ptr(settings.background));
  glUniform1f(exposure_location, settings.exposure);
  glUniform1i(use_openness_location, !settings.openness.empty());
  draw_fullscreen(empty_);
  end_pass();

  // Read in the picture's own format: the driver then copies and need not convert.
  const std::size_t count =
      static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height);
  rgba_.resize(4 * count);
  picture_.read(std::as_writable_bytes(std::span(rgba_)));
  out.width = gbuffer.width;
  out.height = gbuffer.height;
  out.channels = 3;
  out.pixels.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) out.pixels[3 * i + c] = rgba_[4 * i + c];
  }
}

}  // namespace tenebra::raster
