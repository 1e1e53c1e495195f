// OpenGL objects that delete themselves: move-only names, made and filled without binding (DSA of
// OpenGL 4.5). All of it needs a current gl::Context, destructors included.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::gl {

/// Owns the name of one OpenGL object; 0: none.
template <void (*Delete)(unsigned name)>
class Object {
public:
  Object() = default;
  explicit Object(unsigned name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) Delete(name_);
  }
  unsigned name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

private:
  unsigned name_ = 0;
};

void delete_buffer(unsigned name);
void delete_texture(unsigned name);
void delete_framebuffer(unsigned name);
void delete_vertex_array(unsigned name);
void delete_program(unsigned name);

class Buffer : public Object<delete_buffer> {
public:
  using Object::Object;
  static Buffer create();
  /// Replaces the contents; storage grows and is kept. Fails if there is no memory for it.
  Expected<void> upload(std::span<const std::byte> bytes);
  /// Room for as many bytes, whose contents have no meaning. Fails if there is no memory for it.
  Expected<void> reserve(std::size_t bytes);
  /// Replaces the bytes from `offset` on; the contents reach as far already.
  void update(std::size_t offset, std::span<const std::byte> bytes);

private:
  std::size_t capacity_ = 0;
};

enum class PixelFormat { depth32f, r32ui, r8, r32f, rgba8, rgba32f };
std::size_t bytes_per_pixel(PixelFormat format);

/// A two-dimensional texture without mipmaps; rows are tightly packed in memory, row 0 first.
class Texture : public Object<delete_texture> {
public:
  using Object::Object;
  static Expected<Texture> create(PixelFormat format, int width, int height);
  void upload(std::span<const std::byte> pixels);  ///< width * height pixels of the texture's format
  void read(std::span<std::byte> pixels) const;    ///< the same; waits for the drawing before it
  int width() const { return width_; }
  int height() const { return height_; }
  PixelFormat format() const { return format_; }

private:
  PixelFormat format_ = PixelFormat::rgba8;
  int width_ = 0;
  int height_ = 0;
};

/// A texture's pixels on their way from the GPU, without waiting for them: a buffer and a fence behind the
/// copy.
class Readback {
public:
  Readback() : buffer_(Buffer::create()) {}
  Readback(Readback&& other) noexcept
      : buffer_(std::move(other.buffer_)), fence_(std::exchange(other.fence_, nullptr)), held_(other.held_) {}
  ~Readback();

  /// Copies all pixels as they are once the drawing before is done. Fails if there is no memory for it.
  Expected<void> start(const Texture& texture);
  /// Waits for what start began, and gives it: as many bytes as the texture has.
  Expected<void> finish(std::span<std::byte> pixels);

private:
  Buffer buffer_;
  void* fence_ = nullptr;  // a GLsync
  std::size_t held_ = 0;   // bytes that the buffer has room for
};

class Framebuffer : public Object<delete_framebuffer> {
public:
  using Object::Object;
  /// Draws to `colors` (locations 0, 1, ...) and to `depth` if it is not null.
  static Expected<Framebuffer> create(std::initializer_list<const Texture*> colors,
                                      const Texture* depth = nullptr);
};

class VertexArray : public Object<delete_vertex_array> {
public:
  using Object::Object;
  static VertexArray create();
  void attach_vec3(unsigned location, const Buffer& buffer);  ///< three packed floats per vertex
  void attach_indices(const Buffer& buffer);
};

class Program : public Object<delete_program> {
public:
  using Object::Object;
  /// Compiles and links; the pieces of a stage are joined behind "#version 450 core". Fails with `name`, the
  /// stage and the compiler's log.
  static Expected<Program> build(std::string_view name, std::vector<std::string_view> vertex,
                                 std::vector<std::string_view> fragment);
  /// The same of a compute shader alone.
  static Expected<Program> build_compute(std::string_view name, std::vector<std::string_view> pieces);
};

/// Waits until all drawing is done: the driver's threads then leave the cores to ours.
void finish();

}  // namespace tenebra::gl
