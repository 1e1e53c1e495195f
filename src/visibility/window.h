// A view in double: where world positions are in the window, and bounds on the rounding. Internal to
// visibility.
#pragma once

#include <glm/glm.hpp>

#include <tenebra/frame_geometry.h>
#include "visibility/clip_transform.h"

namespace tenebra::visibility {

/// Window coordinates are in pixels, y down, the centre of pixel (x, y) at (x + 0.5, y + 0.5). With
/// q = p - eye a position is at x = x_row.q, y = y_row.q and t = t_row.q along the ray; in perspective x and
/// y are divided by t. Depths are those of ClipTransform.
struct Window {
  Window(const ViewRays& view, const ClipTransform& transform, int width, int height);

  glm::dvec3 eye, d0, dx, dy;
  glm::dvec3 t_row, x_row, y_row;
  bool orthographic = false;
  int width = 0;
  int height = 0;
  double near_t = 0;
  double far_t = 0;  ///< orthographic only

  /// A vertex has a place in the window if t is above this times the L1 norm of q (perspective), or that norm
  /// below `farthest` (orthographic).
  double least_slope = 0;
  double farthest = 0;
  /// What places as floats are off by at most, in the window or just beside it; pixels.
  float margin = 0;
  /// The values of an edge through a and b (relative to the eye) at pixels of the window are off by at most
  /// 20 u (|a| + shift) (|b| + shift) reach, with L1 norms and u = 2^-53, computed as in setup_kernels.cpp.
  double reach = 0;
  double shift = 0;
};

}  // namespace tenebra::visibility
