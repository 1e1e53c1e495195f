// The corners of a triangle by its id, and from which side a view sees it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include <tenebra/visible_points.h>
#include "math/predicates.h"
#include "points/contact_rule.h"

namespace tenebra::points {

struct Corners {
  glm::vec3 v[3];
};

inline Corners corners_of(const TriangleView& triangles, std::size_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  return {{triangles.positions[t.x], triangles.positions[t.y], triangles.positions[t.z]}};
}

/// Rounding tolerance of what the point `p` lies on: its triangle or, if it is free, its place.
inline double own_tolerance(const TriangleView& triangles, std::uint32_t id, const glm::dvec3& p) {
  if (id != free_point) return rounding_tolerance(corners_of(triangles, id).v);
  return contact_tau * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// The side of the triangle that the eye is on: +1 where (B - A) x (C - A) points, -1 on the other; 0:
/// edge-on, or no area. Exact; orthographic views: the eye is at infinity against d0.
inline int eye_side(const glm::vec3 v[3], const ViewRays& view) {
  return view.orthographic ? -math::direction_side(v[0], v[1], v[2], view.d0)
                           : math::point_side(v[0], v[1], v[2], view.eye);
}

}  // namespace tenebra::points
