#include "raster/geometry_buffers.h"

#include "base/fail.h"

#include <glad/gl.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace tenebra::raster {
namespace {

constexpr unsigned position_location = 0;  // of shaders/gbuffer.vert
constexpr std::size_t max_triangles = std::numeric_limits<GLsizei>::max() / 3;

template <class T>
Expected<void> send(gl::Buffer& buffer, const std::vector<T>& values) {
  return buffer.upload(std::as_bytes(std::span(values)));
}

void draw_elements(const gl::VertexArray& vertices, std::size_t triangles) {
  if (triangles == 0) return;
  glBindVertexArray(vertices.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

}  // namespace

GeometryBuffers::GeometryBuffers()
    : positions_(gl::Buffer::create()),
      indices_(gl::Buffer::create()),
      see_through_indices_(gl::Buffer::create()),
      vertices_(gl::VertexArray::create()),
      see_through_(gl::VertexArray::create()) {
  vertices_.attach_vec3(position_location, positions_);
  vertices_.attach_indices(indices_);
  see_through_.attach_vec3(position_location, positions_);
  see_through_.attach_indices(see_through_indices_);
}

Expected<void> GeometryBuffers::upload(const FrameGeometry& geometry) {
  if (geometry.triangles.size() > max_triangles) {
    return base::fail("OpenGL: found {} triangles, expected at most {}", geometry.triangles.size(),
                      max_triangles);
  }
  triangle_count_ = geometry.triangles.size();
  bounds_ = visibility::bounds_of(geometry.positions);
  if (auto sent = send(positions_, geometry.positions); !sent) return sent;
  has_see_through_ = std::any_of(geometry.see_through.begin(), geometry.see_through.end(),
                                 [](std::uint8_t through) { return through != 0; });
  if (!has_see_through_) return send(indices_, geometry.triangles);
  const auto send_kind = [&](bool see_through, gl::Buffer& to) {
    sorted_ = geometry.triangles;
    for (std::size_t i = 0; i < sorted_.size(); ++i)
      if ((geometry.see_through[i] != 0) != see_through) sorted_[i] = glm::uvec3(0);
    return send(to, sorted_);
  };
  if (auto sent = send_kind(false, indices_); !sent) return sent;
  return send_kind(true, see_through_indices_);
}

void GeometryBuffers::draw() const {
  draw_elements(vertices_, triangle_count_);
}

void GeometryBuffers::draw_see_through() const {
  if (has_see_through_) draw_elements(see_through_, triangle_count_);
}

}  // namespace tenebra::raster
