#include "gl/objects.h"

#include "base/fail.h"

#include <glad/gl.h>

#include <cassert>
#include <utility>

namespace tenebra::gl {
namespace {

struct Formats {
  GLenum internal, external, type;
  std::size_t bytes;
};

Formats formats_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::depth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    case PixelFormat::r32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    case PixelFormat::r8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
    case PixelFormat::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 4};
    case PixelFormat::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case PixelFormat::rgba32f:
      break;
  }
  return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
}

}  // namespace

void delete_buffer(unsigned name) {
  glDeleteBuffers(1, &name);
}
void delete_texture(unsigned name) {
  glDeleteTextures(1, &name);
}
void delete_framebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}
void delete_vertex_array(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

Buffer Buffer::create() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return Buffer(name);
}

Expected<void> Buffer::upload(std::span<const std::byte> bytes) {
  if (bytes.size() > capacity_) {
    glGetError();  // an older error is not ours
    glNamedBufferData(name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
    if (glGetError() != GL_NO_ERROR) {
      capacity_ = 0;
      return base::fail(ErrorKind::device, "OpenGL: found no memory for a buffer of {} bytes", bytes.size());
    }
    capacity_ = bytes.size();
  } else if (!bytes.empty()) {
    glNamedBufferSubData(name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  }
  return {};
}

Expected<void> Buffer::reserve(std::size_t bytes) {
  if (bytes <= capacity_) return {};
  glGetError();  // an older error is not ours
  glNamedBufferData(name(), static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
  capacity_ = glGetError() == GL_NO_ERROR ? bytes : 0;
  if (capacity_ == 0)
    return base::fail(ErrorKind::device, "OpenGL: found no memory for a buffer of {} bytes", bytes);
  return {};
}

void Buffer::update(std::size_t offset, std::span<const std::byte> bytes) {
  assert(offset + bytes.size() <= capacity_);
  glNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
                       bytes.data());
}

std::size_t bytes_per_pixel(PixelFormat format) {
  return formats_of(format).bytes;
}

Expected<Texture> Texture::create(PixelFormat format, int width, int height) {
  GLuint name = 0;
  glGetError();  // an older error is not ours
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  Texture texture(name);
  glTextureStorage2D(name, 1, formats_of(format).internal, width, height);
  if (glGetError() != GL_NO_ERROR)
    return base::fail(ErrorKind::device, "OpenGL: found no memory for a target of {}x{} pixels", width,
                      height);
  // Without mipmaps a texture is complete only with a filter that wants none.
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  texture.format_ = format;
  texture.width_ = width;
  texture.height_ = height;
  return texture;
}

void Texture::upload(std::span<const std::byte> pixels) {
  const Formats formats = formats_of(format_);
  assert(pixels.size() ==
         formats.bytes * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(name(), 0, 0, 0, width_, height_, formats.external, formats.type, pixels.data());
}

void Texture::read(std::span<std::byte> pixels) const {
  const Formats formats = formats_of(format_);
  assert(pixels.size() ==
         formats.bytes * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  // The size is the buffer's capacity: a GLsizei holds it up to the largest picture (see check_picture_size).
  glGetTextureImage(name(), 0, formats.external, formats.type, static_cast<GLsizei>(pixels.size()),
                    pixels.data());
}

Readback::~Readback() {
  if (fence_ != nullptr) glDeleteSync(static_cast<GLsync>(fence_));
}

Expected<void> Readback::start(const Texture& texture) {
  const Formats formats = formats_of(texture.format());
  const std::size_t bytes =
      formats.bytes * static_cast<std::size_t>(texture.width()) * static_cast<std::size_t>(texture.height());
  if (bytes != held_) {
    glGetError();  // an older error is not ours
    glNamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    held_ = glGetError() == GL_NO_ERROR ? bytes : 0;
    if (held_ == 0)
      return base::fail(ErrorKind::device, "OpenGL: found no memory for a buffer of {} bytes", bytes);
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
  glGetTextureImage(texture.name(), 0, formats.external, formats.type, static_cast<GLsizei>(bytes), nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (fence_ != nullptr) glDeleteSync(static_cast<GLsync>(fence_));
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return {};
}

Expected<void> Readback::finish(std::span<std::byte> pixels) {
  assert(pixels.size() == held_ && fence_ != nullptr);
  constexpr GLuint64 second_ns = 1000000000;
  GLenum state = GL_TIMEOUT_EXPIRED;
  while (state == GL_TIMEOUT_EXPIRED) {
    state = glClientWaitSync(static_cast<GLsync>(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, second_ns);
  }
  glDeleteSync(static_cast<GLsync>(std::exchange(fence_, nullptr)));
  if (state == GL_WAIT_FAILED)
    return base::fail(ErrorKind::device, "OpenGL: found a lost context while reading back pixels");
  glGetNamedBufferSubData(buffer_.name(), 0, static_cast<GLsizeiptr>(pixels.size()), pixels.data());
  return {};
}

Expected<Framebuffer> Framebuffer::create(std::initializer_list<const Texture*> colors,
                                          const Texture* depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  Framebuffer framebuffer(name);
  std::vector<GLenum> buffers;
  for (const Texture* color : colors) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    glNamedFramebufferTexture(name, buffers.back(), color->name(), 0);
  }
  if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth->name(), 0);
  glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(buffers.size()), buffers.data());
  const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return base::fail(ErrorKind::device, "OpenGL: found an incomplete framebuffer (status {:#x})", status);
  return framebuffer;
}

VertexArray VertexArray::create() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

void VertexArray::attach_vec3(unsigned location, const Buffer& buffer) {
  glVertexArrayVertexBuffer(name(), location, buffer.name(), 0, 3 * sizeof(float));
  glVertexArrayAttribFormat(name(), location, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(name(), location, location);
  glEnableVertexArrayAttrib(name(), location);
}

void VertexArray::attach_indices(const Buffer& buffer) {
  glVertexArrayElementBuffer(name(), buffer.name());
}

void finish() {
  glFinish();
}

}  // namespace tenebra::gl
