// A parallelepiped around the points of a group.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "soft/light/light_shape.h"

namespace tenebra::soft {

/// A parallelepiped centre +- axis[0] +- axis[1] +- axis[2], around points. Every point lies within `slack`
/// (per coordinate) of it.
struct Cell {
  glm::dvec3 centre{0.0};
  std::array<glm::dvec3, 3> axis{};
  double slack = 0;
  double reach = 0;  ///< largest |coordinate|, slack included
};

/// The cell of the box low..high (world space).
Cell box_cell(const glm::dvec3& low, const glm::dvec3& high, const LightShape& light);

}  // namespace tenebra::soft
