// The G-buffer: which triangle each pixel sees, and how far away.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "gl/objects.h"
#include "raster/geometry_buffers.h"
#include "visibility/clip_transform.h"

namespace tenebra::raster {

/// Targets of one size, kept from frame to frame. Normals and materials are not in it: the triangle's id
/// leads to them.
struct GBuffer {
  int width = 0;
  int height = 0;
  ViewRays view;  ///< what it was drawn with
  visibility::ClipTransform transform;
  gl::Texture depth;  ///< 32-bit float; see visibility::ClipTransform
  gl::Texture ids;    ///< triangle ids; 0xffffffff where none is seen
  gl::Framebuffer framebuffer;

  /// The nearest see-through triangles before the opaque ones; of scenes that have any.
  gl::Texture layer_depth;
  gl::Texture layer_ids;
  gl::Framebuffer layer;
  bool has_layer = false;  ///< the last draw had any
};

/// Fails with a sentence on sizes below 1 or beyond what this OpenGL or a picture in one piece can hold.
Expected<void> check_picture_size(int width, int height);

class GBufferPass {
public:
  static Expected<GBufferPass> create();

  /// Draws all opaque triangles, two-sided, cut by the near plane. Where depths are equal the smaller id is
  /// seen. Where there are see-through triangles, the nearest of them go to the layer, if before what is
  /// opaque. Done when it returns. Fails on sizes that check_picture_size refuses and on rays that span no
  /// picture.
  Expected<void> draw(const ViewRays& view, const GeometryBuffers& geometry, int width, int height,
                      GBuffer& out) const;

private:
  gl::Program program_;
};

/// width * height values, row 0 at the top.
void read_triangle_ids(const GBuffer& gbuffer, std::vector<std::uint32_t>& ids);
/// The ids of GBuffer::layer, if has_layer.
void read_layer_ids(const GBuffer& gbuffer, std::vector<std::uint32_t>& ids);
void read_depth(const GBuffer& gbuffer, std::vector<float>& depth);  ///< 0 where no triangle is seen

}  // namespace tenebra::raster
