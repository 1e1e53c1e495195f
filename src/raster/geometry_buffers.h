// The frame's triangles in OpenGL's memory.
#pragma once

#include <cstddef>

#include <tenebra/frame_geometry.h>
#include "gl/objects.h"
#include "raster/clip_transform.h"

namespace tenebra::raster {

class GeometryBuffers {
public:
  GeometryBuffers();

  /// Once per frame. Fails on more triangles than OpenGL can index.
  Expected<void> upload(const FrameGeometry& geometry);

  std::size_t triangle_count() const { return triangle_count_; }
  const Box& bounds() const { return bounds_; }

  void draw() const;  ///< all triangles in one call: gl_PrimitiveID is the triangle id

private:
  gl::Buffer positions_, indices_;
  gl::VertexArray vertices_;
  std::size_t triangle_count_ = 0;
  Box bounds_;
};

}  // namespace tenebra::raster
