#include "raster/geometry_buffers.h"

#include "base/fail.h"

#include <glad/gl.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace tenebra::raster {
namespace {

constexpr unsigned position_location = 0;  // of shaders/gbuffer.vert
constexpr std::size_t max_triangles = std::numeric_limits<GLsizei>::max() / 3;

constexpr std::size_t run = 4096;  // values that are compared, and sent, together

/// Sends what differs from `sent`, what the buffer holds.
template <class T>
Expected<void> send_changed(gl::Buffer& buffer, const std::vector<T>& values, std::vector<T>& sent) {
  if (values.size() != sent.size()) {
    sent.clear();
    if (auto all = buffer.upload(std::as_bytes(std::span(values))); !all) return all;
    sent = values;
    return {};
  }
  const auto differs = [&](std::size_t first) {
    const std::size_t count = std::min(run, values.size() - first);
    return std::memcmp(&values[first], &sent[first], count * sizeof(T)) != 0;
  };
  const auto at = [](auto& list, std::size_t i) { return list.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t first = 0, end = 0; first < values.size(); first = end) {
    end = first;
    while (end < values.size() && differs(end)) end += run;
    end = std::min(end, values.size());
    if (end == first) {
      end += run;
      continue;
    }
    std::copy(at(values, first), at(values, end), at(sent, first));
    buffer.update(first * sizeof(T), std::as_bytes(std::span(values).subspan(first, end - first)));
  }
  return {};
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
    return base::fail(ErrorKind::device, "OpenGL: found {} triangles, expected at most {}",
                      geometry.triangles.size(), max_triangles);
  }
  triangle_count_ = geometry.triangles.size();
  bounds_ = visibility::bounds_of(geometry.positions);
  if (auto sent = send_changed(positions_, geometry.positions, sent_positions_); !sent) return sent;
  has_see_through_ = std::any_of(geometry.see_through.begin(), geometry.see_through.end(),
                                 [](std::uint8_t through) { return through != 0; });
  if (!has_see_through_) return send_changed(indices_, geometry.triangles, sent_indices_);
  const auto send_kind = [&](bool see_through, gl::Buffer& to, std::vector<glm::uvec3>& held) {
    sorted_ = geometry.triangles;
    for (std::size_t i = 0; i < sorted_.size(); ++i)
      if ((geometry.see_through[i] != 0) != see_through) sorted_[i] = glm::uvec3(0);
    return send_changed(to, sorted_, held);
  };
  if (auto sent = send_kind(false, indices_, sent_indices_); !sent) return sent;
  return send_kind(true, see_through_indices_, sent_see_through_);
}

void GeometryBuffers::draw() const {
  draw_elements(vertices_, triangle_count_);
}

void GeometryBuffers::draw_see_through() const {
  if (has_see_through_) draw_elements(see_through_, triangle_count_);
}

}  // namespace tenebra::raster
