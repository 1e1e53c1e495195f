#include "points/receiver.h"

#include <algorithm>
#include <cmath>

namespace tenebra::points {

namespace {

using glm::dvec3;

// Negative weights to 0, renormalised. The point is then a double rounding off the plane, far inside the
// contact rule's tolerance.
dvec3 clamped(const Receiver& r, double u, double v) {
  const double w0 = std::max(0.0, 1 - u - v), w1 = std::max(0.0, u), w2 = std::max(0.0, v);
  const double sum = w0 + w1 + w2;
  return r.a + (w1 / sum) * r.e1 + (w2 / sum) * r.e2;
}

}  // namespace

Receiver receiver_of(const TriangleView& triangles, std::uint32_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  Receiver r;
  r.id = id;
  r.a = triangles.positions[t.x];
  r.e1 = dvec3(triangles.positions[t.y]) - r.a;
  r.e2 = dvec3(triangles.positions[t.z]) - r.a;
  r.normal = glm::cross(r.e1, r.e2);
  const double area2 = glm::dot(r.normal, r.normal);
  r.flat = !(area2 > 0);
  if (!r.flat) {
    r.du = glm::cross(r.e2, r.normal) / area2;
    r.dv = glm::cross(r.normal, r.e1) / area2;
  }
  return r;
}

dvec3 visible_point(const Receiver& r, const dvec3& origin, const dvec3& direction) {
  const double speed = glm::dot(r.normal, direction);
  const double t = glm::dot(r.normal, r.a - origin) / speed;
  if (r.flat || !(t > 0) || !std::isfinite(t)) return r.a + (r.e1 + r.e2) / 3.0;
  const dvec3 p = origin + t * direction;
  const double u = glm::dot(r.du, p - r.a), v = glm::dot(r.dv, p - r.a);
  if (u >= 0 && v >= 0 && u + v <= 1) return p;
  if (!std::isfinite(u) || !std::isfinite(v)) return r.a + (r.e1 + r.e2) / 3.0;
  return clamped(r, u, v);
}

}  // namespace tenebra::points
