// Which triangle each pixel sees, on the CPU: what the G-buffer pass of `raster` finds, without OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/simd_level.h>
#include "visibility/clip_transform.h"
#include "visibility/place_ids.h"

namespace tenebra::visibility {

/// What is seen of a frame. Lists of width * height, row 0 at the top.
struct VisibleIds {
  int width = 0;
  int height = 0;
  ClipTransform transform;
  std::vector<std::uint32_t> ids;    ///< 0xffffffff where no opaque triangle is seen
  std::vector<float> depth;          ///< as ClipTransform says; 0 where none is seen; empty: not asked for
  std::vector<std::uint32_t> layer;  ///< nearest see-through triangle before those; empty without any
  bool has_layer = false;            ///< the frame has see-through triangles
};

/// Fails with a sentence on sizes below 1 or beyond what a picture in one piece can hold.
Expected<void> check_picture_size(int width, int height);

/// Whether the frame has see-through triangles.
bool has_see_through(const FrameGeometry& geometry);

/// Draws frames; keeps its buffers. One caller at a time.
class VisibilityPass {
public:
  VisibilityPass();
  VisibilityPass(VisibilityPass&&) noexcept;
  VisibilityPass& operator=(VisibilityPass&&) noexcept;
  ~VisibilityPass();

  /// All triangles, two-sided, cut by the near plane. A triangle covers a pixel if the ray through the
  /// pixel's centre meets it, its edges included: exactly, so that no ray slips between two triangles that
  /// share an edge or around a vertex, whether they are tiny, huge or reach behind the eye. Of the triangles
  /// that cover a pixel the nearest is seen, by depths in float; the smaller id where they are equal. The
  /// bits depend neither on the number of threads nor on the instruction set. Fails on sizes that
  /// check_picture_size refuses, on rays that span no picture and on more triangles or vertices than 2^29.
  Expected<void> draw(const FrameGeometry& geometry, const ViewRays& view, int width, int height,
                      bool with_depth, SimdLevel simd, VisibleIds& out);

  /// Draws the ids at up to sixteen places of each pixel at once (from its centre, less than 0.5 each way,
  /// multiples of 1/512), in place of its centre: a triangle covers a place if the ray through it does,
  /// exactly. Returns false, with `out` unspecified, where the triangles or the places are too many to be
  /// held at once. Threads and instruction set change no bit here either.
  Expected<bool> draw_places(const FrameGeometry& geometry, const ViewRays& view, int width, int height,
                             std::span<const glm::vec2> places, SimdLevel simd, PlaceIds& out);

private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace tenebra::visibility
