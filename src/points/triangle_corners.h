// The corners of a triangle by its id, and from which side it is seen.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include <tenebra/visible_points.h>
#include "math/predicates.h"

namespace tenebra::points {

struct Corners {
  glm::vec3 v[3];
};

inline Corners corners_of(const TriangleView& triangles, std::size_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  return {{triangles.positions[t.x], triangles.positions[t.y], triangles.positions[t.z]}};
}

/// The side of the triangle that the eye is on: +1 where (B - A) x (C - A) points, -1 on the other; 0:
/// edge-on, or no area. Exact; orthographic views: the eye is at infinity against d0.
inline int eye_side(const glm::vec3 v[3], const ViewRays& view) {
  return view.orthographic ? -math::direction_side(v[0], v[1], v[2], view.d0)
                           : math::point_side(v[0], v[1], v[2], view.eye);
}

}  // namespace tenebra::points
