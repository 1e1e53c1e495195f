#include "raster/geometry_buffers.h"

#include "base/fail.h"

#include <glad/gl.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace tenebra::raster {
namespace {

constexpr unsigned position_location = 0;  // of shaders/gbuffer.vert
constexpr std::size_t max_triangles = std::numeric_limits<GLsizei>::max() / 3;

Box bounds_of(std::span<const glm::vec3> positions) {
  const float huge = std::numeric_limits<float>::max();
  Box box{glm::vec3(huge), glm::vec3(-huge)};
  for (const glm::vec3& p : positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    box.min = glm::min(box.min, p);
    box.max = glm::max(box.max, p);
  }
  return box;
}

template <class T>
Expected<void> send(gl::Buffer& buffer, const std::vector<T>& values) {
  return buffer.upload(std::as_bytes(std::span(values)));
}

}  // namespace

GeometryBuffers::GeometryBuffers()
    : positions_(gl::Buffer::create()), indices_(gl::Buffer::create()), vertices_(gl::VertexArray::create()) {
  vertices_.attach_vec3(position_location, positions_);
  vertices_.attach_indices(indices_);
}

Expected<void> GeometryBuffers::upload(const FrameGeometry& geometry) {
  if (geometry.triangles.size() > max_triangles) {
    return base::fail("OpenGL: found {} triangles, expected at most {}", geometry.triangles.size(),
                      max_triangles);
  }
  triangle_count_ = geometry.triangles.size();
  bounds_ = bounds_of(geometry.positions);
  if (auto sent = send(positions_, geometry.positions); !sent) return sent;
  return send(indices_, geometry.triangles);
}

void GeometryBuffers::draw() const {
  if (triangle_count_ == 0) return;
  glBindVertexArray(vertices_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangle_count_), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

}  // namespace tenebra::raster
