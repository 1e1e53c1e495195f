// A receiver as the rays of a perspective view see it: what a tile of its points needs to be made in float
// (seen_plane-inl.h).
#pragma once

#include <glm/glm.hpp>

#include <tenebra/visible_points.h>
#include "points/receiver.h"

namespace tenebra::points {

/// The rays of a perspective view in rows of four doubles (the last is 0), to be read as vectors.
struct alignas(32) RayRows {
  explicit RayRows(const ViewRays& view, int width, int height);

  double d0[4], dx[4], dy[4];
  double longest;  ///< >= the sum of |d| of the coordinates of all directions, with two pixels around the
                   ///< picture
};

/// With s = n.d for the direction d through pixel (x, y): s times the weights 1 - u - v, u, v and 1 of the
/// point where the ray meets the plane. These are linear in the pixel: at0 + x dx + y dy.
struct alignas(32) SeenPlane {
  double at0[4], dx[4], dy[4];
  double half[4];       ///< the most by which these change from a tile's middle to its pixels
  double height;        ///< n.(a - eye): the ray meets the plane at t = height / s
  double normal;        ///< >= |n| longest
  double distance;      ///< >= |a - eye|
  double weights;       ///< >= |du| + |dv|
  double height_reach;  ///< >= |height| longest
};
SeenPlane seen_plane(const Receiver& receiver, const PixelRays& rays, const RayRows& rows);

/// Where the points of a square are looked at from.
struct alignas(32) SquareEye {
  double from_base[4];  ///< eye - base, and 0
  double rounding;      ///< 2^-50 (|eye| + |base|)
};
SquareEye square_eye(const glm::dvec3& eye, const glm::vec3& base);

/// How far the q of a square may be off, beyond their own rounding.
struct alignas(16) PlaneError {
  float steps[4] = {};  ///< the most by which q changes from a tile's middle to its pixels, by coordinates
  double off = 0;       ///< what doubles are off
  bool none() const { return off == 0; }
};
/// PointBase::grain of a square of this radius.
float grain_of(float radius, const PlaneError& error);

}  // namespace tenebra::points
