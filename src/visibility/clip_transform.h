// The pixel rays of a view as rasterisers need them: the same floats that define the rays make the clip
// coordinates, so that what a rasteriser finds at a pixel is what the ray through the pixel's centre meets.
// Window y runs down the picture: row 0, the top one, is at window y = 0, and nothing is ever flipped.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include "math/box.h"

namespace tenebra::visibility {

/// Smallest box around all finite positions of a frame.
math::Box<float> bounds_of(std::span<const glm::vec3> positions);

/// Takes a world position p, with q = p - eye, to clip coordinates: clip_from_offset * q + clip_offset, made
/// for depth 0..1. Depth is reversed, 1 at the near plane, so that floats are dense far away where depths
/// crowd. Ray parameter t (of ViewRays: q = t d) from depth z: perspective, without far plane, near_t / z;
/// orthographic, where the far plane lies behind all geometry, mix(far_t, near_t, z).
struct ClipTransform {
  glm::mat3x4 clip_from_offset{0.0f};
  glm::vec4 clip_offset{0.0f};
  float near_t = 0;
  float far_t = 0;  ///< orthographic only
};

/// Fails if the rays are not finite or do not span a picture (no width, height or depth).
Expected<ClipTransform> clip_transform(const ViewRays& view, const math::Box<float>& bounds, int width,
                                       int height);

/// The point that pixel (x, y), row 0 at the top, sees at depth `depth` > 0: the paper's reconstruction, as
/// exact as float depth is: too coarse to do without a bias.
glm::dvec3 point_from_depth(const ViewRays& view, const ClipTransform& transform, int x, int y, float depth);

}  // namespace tenebra::visibility
