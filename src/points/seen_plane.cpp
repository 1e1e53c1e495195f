#include "points/seen_plane.h"

#include <algorithm>
#include <cmath>

namespace tenebra::points {

namespace {

using glm::dvec3;

double l1_norm(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

void put(const dvec3& v, double to[4]) {
  to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = 0;
}

}  // namespace

RayRows::RayRows(const ViewRays& view, int width, int height) {
  put(view.d0, d0), put(view.dx, dx), put(view.dy, dy);
  longest = l1_norm(view.d0) + (width + 4) * l1_norm(view.dx) + (height + 4) * l1_norm(view.dy);
}

// p - a = (eye - a) + t d with t s = height, so s u = (du.(eye - a)) s + height du.d, and likewise v.
SeenPlane seen_plane(const Receiver& r, const PixelRays& rays, const RayRows& rows) {
  SeenPlane plane{};
  const dvec3 eye = rays.eye - r.a;
  plane.height = -glm::dot(r.normal, eye);
  const double u = glm::dot(r.du, eye), v = glm::dot(r.dv, eye);
  const auto values_of = [&](const dvec3& d, double to[4]) {
    const double s = glm::dot(r.normal, d);
    to[1] = u * s + plane.height * glm::dot(r.du, d);
    to[2] = v * s + plane.height * glm::dot(r.dv, d);
    to[0] = s - to[1] - to[2];
    to[3] = s;
  };
  values_of(rays.d0, plane.at0), values_of(rays.dx, plane.dx), values_of(rays.dy, plane.dy);
  for (int i = 0; i < 4; ++i) plane.half[i] = 1.5 * (std::abs(plane.dx[i]) + std::abs(plane.dy[i]));
  plane.normal = l1_norm(r.normal) * rows.longest;
  plane.distance = l1_norm(eye);
  plane.weights = l1_norm(r.du) + l1_norm(r.dv);
  plane.height_reach = std::abs(plane.height) * rows.longest;
  return plane;
}

SquareEye square_eye(const dvec3& eye, const glm::vec3& base) {
  SquareEye square{};
  put(eye - dvec3(base), square.from_base);
  square.rounding = 0x1p-50 * (l1_norm(eye) + l1_norm(base));
  return square;
}

// What PlaneError and the rounding of q leave (see_plane): a sum of at most 2 radius + 10 |steps| + 2^24 off,
// and where floats are denormal 16 of the least of them. What is rounded here is far below 2^-20.
float grain_of(float radius, const PlaneError& error) {
  if (error.none()) return radius;
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis)
    squares += static_cast<double>(error.steps[axis]) * static_cast<double>(error.steps[axis]);
  const double grain = 2 * static_cast<double>(radius) + 10 * std::sqrt(squares) + 0x1p24 * error.off;
  return static_cast<float>(grain) * (1 + 0x1p-20f) + 0x1p-120f;
}

}  // namespace tenebra::points
