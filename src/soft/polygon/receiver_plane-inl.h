// The plane that a point lies on, as far as the light is concerned: its horizon as a line on the light's
// plane. Included once per target.
#if defined(TENEBRA_SOFT_RECEIVER_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_RECEIVER_PLANE_INL_H_
#undef TENEBRA_SOFT_RECEIVER_PLANE_INL_H_
#else
#define TENEBRA_SOFT_RECEIVER_PLANE_INL_H_
#endif

#include <cmath>
#include <span>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "soft/light/light_frame.h"
#include "soft/polygon/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
LightPolygon<T> polygon_of(std::span<const glm::dvec2> polygon) {
  T x[polygon_capacity], y[polygon_capacity];
  for (std::size_t k = 0; k < polygon_capacity; ++k) {
    const glm::dvec2 at = polygon[k < polygon.size() ? k : 0];
    x[k] = static_cast<T>(at.x);
    y[k] = static_cast<T>(at.y);
  }
  using Lanes = typename LightPolygon<T>::Lanes;
  return {load<Lanes>(x), load<Lanes>(y), static_cast<int>(polygon.size())};
}

template <class T>
LightLine<T> line_of(const glm::dvec3& line) {
  const double size = std::abs(line.x) + std::abs(line.y) + std::abs(line.z);
  const glm::dvec3 scaled = size > 0 ? line / size : line;
  return {static_cast<T>(scaled.x), static_cast<T>(scaled.y), static_cast<T>(scaled.z)};
}

/// The triangle a point lies on, as far as the light is concerned.
struct ReceiverPlane {
  std::uint32_t id = no_triangle;
  double tau = 0;
  glm::dvec3 horizon{0.0};  ///< line on the light's plane, positive above
  glm::dvec3 face{0.0};     ///< unit normal on the points' side; 0: no area
  LightLine<float> line;    ///< the horizon, scaled
  bool cuts_light = true;   ///< part of the light is not above it
  double level = 0;         ///< face.p of points on it
};

inline ReceiverPlane receiver_plane(const LightFrame& light, const TriangleView& triangles, std::uint32_t id,
                                    int side) {
  const points::Corners c = points::corners_of(triangles, id);
  const glm::dvec3 a(c.v[0]);
  const glm::dvec3 n = glm::cross(glm::dvec3(c.v[1]) - a, glm::dvec3(c.v[2]) - a);
  const double length = std::sqrt(glm::dot(n, n));
  ReceiverPlane plane;
  plane.id = id;
  plane.tau = points::rounding_tolerance(c.v);
  if (!(length > 0) || side == 0) return plane;
  plane.horizon = static_cast<double>(side) * line_of_plane(light, n, light.way_from(a));
  plane.face = static_cast<double>(side) / length * n;
  plane.level = glm::dot(plane.face, a);
  return plane;
}

/// The plane of a free point: across `normal`, or with a horizon that is below all of the light.
inline ReceiverPlane free_plane(const LightFrame& light, const TriangleView& triangles, const glm::dvec3& at,
                                const glm::dvec3& normal, bool sees_half) {
  ReceiverPlane plane;
  plane.id = free_point;
  plane.tau = points::own_tolerance(triangles, free_point, at);
  plane.horizon = sees_half ? line_of_plane(light, normal, light.way_from(at)) : glm::dvec3(0, 0, 1);
  plane.face = normal;
  plane.level = glm::dot(normal, at);
  return plane;
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
