// A triangle that pixels see: where their rays meet it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/visible_points.h>

namespace tenebra::points {

/// What the pixels of one triangle share. Barycentric weights of a point p on the plane are
/// u = du.(p - a), v = dv.(p - a), 1 - u - v.
struct Receiver {
  std::uint32_t id = no_triangle;
  glm::dvec3 a, e1, e2, normal, du{0.0}, dv{0.0};
  bool flat = false;  ///< no plane: zero area in double
};
Receiver receiver_of(const TriangleView& triangles, std::uint32_t id);

/// Where origin + t direction meets the triangle's plane, moved into the triangle if it lies beside: negative
/// weights become 0, and the others are scaled to a sum of 1. A ray that misses the plane (the rasteriser saw
/// a triangle edge-on) gets the centroid.
glm::dvec3 visible_point(const Receiver& receiver, const glm::dvec3& origin, const glm::dvec3& direction);

/// The rays of a view's pixels, in double.
struct PixelRays {
  explicit PixelRays(const ViewRays& view)
      : eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy), orthographic(view.orthographic) {}

  glm::dvec3 point_on(const Receiver& receiver, std::size_t x, std::size_t y) const {
    const glm::dvec3 across = (static_cast<double>(x) + 0.5) * dx + (static_cast<double>(y) + 0.5) * dy;
    return orthographic ? visible_point(receiver, eye + across, d0)
                        : visible_point(receiver, eye, d0 + across);
  }

  glm::dvec3 eye, d0, dx, dy;
  bool orthographic;
};

}  // namespace tenebra::points
