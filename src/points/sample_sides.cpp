#include "points/sample_sides.h"

#include <algorithm>
#include <cmath>

namespace tenebra {

int visible_side(const VisiblePoints& points, const TriangleView& triangles, std::size_t pixel) {
  return points::SideFinder(points, triangles).at(pixel);
}

namespace points {

using glm::dvec3;

SeenTogether::SeenTogether(const SeenFrom& from) {
  const ViewRays* const view = ViewOfSamples::of(from);
  if (view == nullptr) return;
  known_ = true;
  eye_ = view->eye, d0_ = view->d0, orthographic_ = view->orthographic;
  const dvec3 dx(view->dx), dy(view->dy), normal = glm::cross(dx, dy);
  const double pixel = 3 * std::max(glm::length(dx), glm::length(dy));
  // A pixel's angle is largest where the picture's plane is nearest to the eye.
  const double plane = orthographic_ ? 1 : std::abs(glm::dot(d0_, normal)) / glm::length(normal);
  most_ = pixel * pixel / (plane * plane);
}

bool SeenTogether::operator()(const dvec3& a, const dvec3& b) const {
  if (!known_) return true;
  if (orthographic_) {
    const dvec3 across = glm::cross(b - a, d0_);
    return glm::dot(across, across) <= most_ * glm::dot(d0_, d0_);
  }
  const dvec3 u = a - eye_, v = b - eye_, across = glm::cross(u, v);
  return glm::dot(across, across) <= most_ * glm::dot(u, u) * glm::dot(v, v);
}

}  // namespace points

}  // namespace tenebra
