// The surface that a triangle's vertex normals describe, and how far the triangle lies below it: where shadow
// rays of smooth-shaded triangles start, so that light that grazes a curved surface ends on it along a smooth
// line and not along the triangles. After Hanika 2021, "Hacking the shadow terminator".
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/visible_points.h>

namespace tenebra::points {

/// A triangle whose vertex normals differ. A point of it with the weights w is lifted by the sum over the
/// vertices of w_i d_i n_i, where d_i is how far the point lies below the plane through vertex i across n_i;
/// nothing where it lies above. Vertices stay where they are, and along an edge the lift follows from the
/// edge's own vertices and normals: triangles that share them have no gap.
struct SmoothSurface {
  bool lifts = false;                   ///< some point, by more than rounding amounts to
  glm::dvec3 a{0.0}, du{0.0}, dv{0.0};  ///< weights of p: u = du.(p - a), v = dv.(p - a), 1 - u - v
  glm::dvec3 normal[3];                 ///< of the vertices, on the samples' side of the triangle
  double fall[3][2];  ///< [i][k]: how far vertex i + 1 + k lies below the plane at vertex i; < 0: above it
};

/// As seen from `side` of the triangle (visible_side()). Does not lift: normals that are all equal, none at
/// all, or not all on one side of the triangle (they contradict it, or each other); triangles without an area
/// or with side 0; planes at the vertices that no vertex is below, as on concave surfaces.
SmoothSurface smooth_surface(const TriangleView& triangles, std::uint32_t id, int side);

/// Where a point of the triangle (weights below zero count as zero) is on the surface.
inline glm::dvec3 lifted(const SmoothSurface& s, const glm::dvec3& p) {
  const glm::dvec3 from = p - s.a;
  const double u = glm::dot(s.du, from), v = glm::dot(s.dv, from);
  const double w0 = std::max(0.0, 1 - u - v), w1 = std::max(0.0, u), w2 = std::max(0.0, v);
  const double d0 = std::max(0.0, w1 * s.fall[0][0] + w2 * s.fall[0][1]),
               d1 = std::max(0.0, w2 * s.fall[1][0] + w0 * s.fall[1][1]),
               d2 = std::max(0.0, w0 * s.fall[2][0] + w1 * s.fall[2][1]);
  return p + (w0 * d0) * s.normal[0] + (w1 * d1) * s.normal[1] + (w2 * d2) * s.normal[2];
}

/// A light at a place or, directional, in a direction.
struct SmoothLight {
  bool directional = false;
  glm::vec3 at{0.0f};
};
/// Whether the triangle, seen from its side `side` (not 0), lifts points and the light
/// is before the plane at one of its vertices. In double.
bool is_before(const TriangleView& triangles, std::uint32_t id, int side, const SmoothLight& light);

}  // namespace tenebra::points
