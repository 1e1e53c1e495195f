// The frame's triangles and the scene's materials in OpenGL's memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include "gl/objects.h"
#include "raster/clip_transform.h"

namespace tenebra::raster {

/// What the passes behind the G-buffer look up by triangle id (shaders/triangles.glsl has the same layout).
struct TriangleRecord {
  glm::vec3 face_normal;  ///< unit, by the right-hand rule; zero for triangles without area
  std::uint32_t material;
};

class GeometryBuffers {
public:
  GeometryBuffers();

  /// Once a scene.
  Expected<void> upload_materials(std::span<const Material> materials);
  /// Once per frame, after the materials. Fails on more triangles than OpenGL can index.
  Expected<void> upload(const FrameGeometry& geometry);

  std::size_t triangle_count() const { return records_.size(); }
  const Box& bounds() const { return bounds_; }

  void draw() const;          ///< all triangles in one call: gl_PrimitiveID is the triangle id
  void bind_records() const;  ///< for shaders with triangles.glsl

private:
  gl::Buffer positions_, normals_, indices_, record_buffer_, material_buffer_;
  gl::BufferTexture record_texture_, material_texture_;
  gl::VertexArray vertices_;
  std::vector<TriangleRecord> records_;
  std::size_t material_count_ = 0;
  Box bounds_;
};

}  // namespace tenebra::raster
