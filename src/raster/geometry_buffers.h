// The frame's triangles in OpenGL's memory.
#pragma once

#include <cstddef>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "gl/objects.h"
#include "visibility/clip_transform.h"

namespace tenebra::raster {

class GeometryBuffers {
public:
  GeometryBuffers();

  /// Once per frame; sends what changed since the last. Fails on more triangles than OpenGL can index.
  Expected<void> upload(const FrameGeometry& geometry);

  std::size_t triangle_count() const { return triangle_count_; }
  bool has_see_through() const { return has_see_through_; }
  const math::Box<float>& bounds() const { return bounds_; }

  /// All opaque triangles, or all see-through ones, in one call: gl_PrimitiveID is the triangle id.
  void draw() const;
  void draw_see_through() const;

private:
  gl::Buffer positions_, indices_, see_through_indices_;  ///< triangles of the other kind have no area in it
  gl::VertexArray vertices_, see_through_;
  std::vector<glm::vec3> sent_positions_;  ///< what the buffers hold
  std::vector<glm::uvec3> sent_indices_, sent_see_through_;
  std::vector<glm::uvec3> sorted_;  ///< scratch
  std::size_t triangle_count_ = 0;
  bool has_see_through_ = false;
  math::Box<float> bounds_;
};

}  // namespace tenebra::raster
