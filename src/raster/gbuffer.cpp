#include "raster/gbuffer.h"

#include <embedded_shaders.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <span>

#include "base/fail.h"
#include "raster/passes.h"

namespace tenebra::raster {
namespace {

// A frame with a hard shadow needs about 60 bytes for each pixel: 4 GB at this many.
constexpr std::int64_t max_pixels = std::int64_t{1} << 26;
constexpr GLuint no_triangle_id = 0xffffffffu;
constexpr int eye_location = 0, clip_from_offset_location = 1, clip_offset_location = 2;

Expected<void> make_targets(int width, int height, GBuffer& out) {
  if (out.framebuffer && out.width == width && out.height == height) return {};
  auto depth = gl::Texture::create(gl::PixelFormat::depth32f, width, height);
  auto ids = gl::Texture::create(gl::PixelFormat::r32ui, width, height);
  for (auto* target : {&depth, &ids}) {
    if (!*target) return tl::unexpected(std::move(target->error()));
  }
  auto framebuffer = gl::Framebuffer::create({&*ids}, &*depth);
  if (!framebuffer) return tl::unexpected(std::move(framebuffer.error()));
  out.depth = std::move(*depth);
  out.ids = std::move(*ids);
  out.framebuffer = std::move(*framebuffer);
  out.width = width;
  out.height = height;
  return {};
}

Expected<void> make_layer(GBuffer& out) {
  if (out.layer && out.layer_ids.width() == out.width && out.layer_ids.height() == out.height) return {};
  auto depth = gl::Texture::create(gl::PixelFormat::depth32f, out.width, out.height);
  auto ids = gl::Texture::create(gl::PixelFormat::r32ui, out.width, out.height);
  for (auto* target : {&depth, &ids}) {
    if (!*target) return tl::unexpected(std::move(target->error()));
  }
  auto framebuffer = gl::Framebuffer::create({&*ids}, &*depth);
  if (!framebuffer) return tl::unexpected(std::move(framebuffer.error()));
  out.layer_depth = std::move(*depth);
  out.layer_ids = std::move(*ids);
  out.layer = std::move(*framebuffer);
  return {};
}

void clear_ids(const gl::Framebuffer& target) {
  const GLuint background[4] = {no_triangle_id, 0, 0, 0};
  glClearNamedFramebufferuiv(target.name(), GL_COLOR, 0, background);
}

void clear(const gl::Framebuffer& target) {
  const GLfloat infinitely_far = 0.0f;
  clear_ids(target);
  glClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &infinitely_far);
}

/// Between begin_pass and end_pass of the opaque triangles, whose depths it begins with.
void draw_layer(const GeometryBuffers& geometry, const GBuffer& gbuffer) {
  glCopyImageSubData(gbuffer.depth.name(), GL_TEXTURE_2D, 0, 0, 0, 0, gbuffer.layer_depth.name(),
                     GL_TEXTURE_2D, 0, 0, 0, 0, gbuffer.width, gbuffer.height, 1);
  clear_ids(gbuffer.layer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, gbuffer.layer.name());
  geometry.draw_see_through();
}

}  // namespace

Expected<void> check_picture_size(int width, int height) {
  if (width < 1 || height < 1)
    return base::fail(ErrorKind::device, "picture: found size {}x{}, expected at least 1x1", width, height);
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  const int max_width = std::min(texture, viewport[0]), max_height = std::min(texture, viewport[1]);
  if (width > max_width || height > max_height) {
    return base::fail(ErrorKind::device,
                      "picture: found size {}x{}, expected at most {}x{} (the limit of this OpenGL)", width,
                      height, max_width, max_height);
  }
  if (std::int64_t{width} * height > max_pixels) {
    return base::fail(ErrorKind::device, "picture: found size {}x{}, expected at most {} pixels", width,
                      height, max_pixels);
  }
  return {};
}

Expected<GBufferPass> GBufferPass::create() {
  auto program = gl::Program::build("gbuffer", {shaders::gbuffer_vert}, {shaders::gbuffer_frag});
  if (!program) return tl::unexpected(std::move(program.error()));
  GBufferPass pass;
  pass.program_ = std::move(*program);
  return pass;
}

Expected<void> GBufferPass::draw(const ViewRays& view, const GeometryBuffers& geometry, int width, int height,
                                 GBuffer& out) const {
  if (auto size = check_picture_size(width, height); !size) return size;
  auto transform = visibility::clip_transform(view, geometry.bounds(), width, height);
  if (!transform) return tl::unexpected(std::move(transform.error()));
  if (auto made = make_targets(width, height, out); !made) return made;
  out.has_layer = geometry.has_see_through();
  if (out.has_layer) {
    if (auto made = make_layer(out); !made) return made;
  }
  out.view = view;
  out.transform = *transform;
  begin_pass(out.framebuffer, program_, width, height);
  clear(out.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glUniform3fv(eye_location, 1, glm::value_ptr(view.eye));
  glUniformMatrix3x4fv(clip_from_offset_location, 1, GL_FALSE, glm::value_ptr(transform->clip_from_offset));
  glUniform4fv(clip_offset_location, 1, glm::value_ptr(transform->clip_offset));
  geometry.draw();
  if (out.has_layer) draw_layer(geometry, out);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_DEPTH_TEST);
  end_pass();
  return {};
}

void read_triangle_ids(const GBuffer& gbuffer, std::vector<std::uint32_t>& ids) {
  ids.resize(static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height));
  gbuffer.ids.read(std::as_writable_bytes(std::span(ids)));
}

void read_layer_ids(const GBuffer& gbuffer, std::vector<std::uint32_t>& ids) {
  ids.resize(static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height));
  gbuffer.layer_ids.read(std::as_writable_bytes(std::span(ids)));
}

void read_depth(const GBuffer& gbuffer, std::vector<float>& depth) {
  depth.resize(static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height));
  gbuffer.depth.read(std::as_writable_bytes(std::span(depth)));
}

}  // namespace tenebra::raster
