#include "raster/geometry_buffers.h"

#include "base/fail.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenebra::raster {
namespace {

// Bindings and locations of the shaders.
constexpr unsigned record_unit = 8, material_unit = 9;
constexpr unsigned position_location = 0, normal_location = 1;

/// Three texels of shaders/triangles.glsl.
struct MaterialRecord {
  glm::vec4 base_color, ambient, emissive;
};

/// In double: the cross product of a sliver's floats would lose its direction.
glm::vec3 face_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double squared = glm::dot(normal, normal);
  // 0 or NaN: no area, or below what double holds; infinity: beyond.
  if (!(squared > 0) || !std::isfinite(squared)) return glm::vec3(0.0f);
  return normal / std::sqrt(squared);
}

void make_records(const FrameGeometry& geometry, std::size_t material_count,
                  std::vector<TriangleRecord>& records) {
  const std::uint32_t last = material_count == 0 ? 0 : static_cast<std::uint32_t>(material_count - 1);
  records.resize(geometry.triangles.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const glm::uvec3 t = geometry.triangles[i];
    records[i] = {face_normal(geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]),
                  std::min(geometry.materials[i], last)};
  }
}

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

std::size_t max_triangles() {
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  const std::size_t drawable = std::numeric_limits<GLsizei>::max() / 3;
  return std::min(static_cast<std::size_t>(texels), drawable);
}

}  // namespace

GeometryBuffers::GeometryBuffers()
    : positions_(gl::Buffer::create()),
      normals_(gl::Buffer::create()),
      indices_(gl::Buffer::create()),
      record_buffer_(gl::Buffer::create()),
      material_buffer_(gl::Buffer::create()),
      record_texture_(gl::BufferTexture::create(record_buffer_)),
      material_texture_(gl::BufferTexture::create(material_buffer_)),
      vertices_(gl::VertexArray::create()) {
  vertices_.attach_vec3(position_location, positions_);
  vertices_.attach_vec3(normal_location, normals_);
  vertices_.attach_indices(indices_);
}

Expected<void> GeometryBuffers::upload_materials(std::span<const Material> materials) {
  std::vector<MaterialRecord> records;
  for (const Material& m : materials) {
    const glm::vec3 ambient = m.ambient.x < 0 ? m.base_color : m.ambient;
    records.push_back({glm::vec4(m.base_color, 0), glm::vec4(ambient, 0), glm::vec4(m.emissive, 0)});
  }
  material_count_ = records.size();
  if (records.empty()) records.push_back({});  // a block that shaders declare must have storage
  return send(material_buffer_, records);
}

Expected<void> GeometryBuffers::upload(const FrameGeometry& geometry) {
  if (const std::size_t most = max_triangles(); geometry.triangles.size() > most) {
    return base::fail("OpenGL: found {} triangles, expected at most {}", geometry.triangles.size(), most);
  }
  make_records(geometry, material_count_, records_);
  bounds_ = bounds_of(geometry.positions);
  if (auto sent = send(positions_, geometry.positions); !sent) return sent;
  if (auto sent = send(normals_, geometry.normals); !sent) return sent;
  if (auto sent = send(indices_, geometry.triangles); !sent) return sent;
  return send(record_buffer_, records_);
}

void GeometryBuffers::draw() const {
  if (records_.empty()) return;
  glBindVertexArray(vertices_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * records_.size()), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

void GeometryBuffers::bind_records() const {
  glBindTextureUnit(record_unit, record_texture_.name());
  glBindTextureUnit(material_unit, material_texture_.name());
}

}  // namespace tenebra::raster
