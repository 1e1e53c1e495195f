// The shaft of a group of points and a light: the convex hull of a cell around the points and the light's
// polygon, as planes with the hull on one side (Haines 2000); for a sun, the endless region that its
// directions sweep from the cell. All coordinates are relative to the light's origin, in double.
#pragma once

#include <tenebra/simd_level.h>
#include <array>
#include <glm/glm.hpp>

#include "soft/groups/cell.h"

namespace tenebra::soft {

/// m.x <= limit for all x of the shaft; |m|_1 <= 1.
struct ShaftPlane {
  glm::dvec3 m{0.0};
  double limit = 0;
};

struct Shaft {
  Cell cell;
  const LightShape* light;
  glm::dvec3 low{0.0}, high{0.0};  ///< box of the shaft, rounded outwards; or infinite
  std::array<ShaftPlane, 7 + most_light_vertices> planes;  ///< those that cut off most come first
  int plane_count = 0;
};

/// Planes are made eight at a time, the same bits on every instruction set.
using ShaftMaker = Shaft (*)(const Cell& cell, const LightShape& light);
ShaftMaker shaft_maker(SimdLevel level);

}  // namespace tenebra::soft
