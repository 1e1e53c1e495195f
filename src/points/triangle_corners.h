// The corners of a triangle by its id.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "points/visible_points.h"

namespace tenebra {

struct Corners {
  glm::vec3 v[3];
};

inline Corners corners_of(const TriangleView& triangles, std::size_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  return {{triangles.positions[t.x], triangles.positions[t.y], triangles.positions[t.z]}};
}

}  // namespace tenebra
