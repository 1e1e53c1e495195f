// The shaft of a group of points and a light: the convex hull of a cell around the points and the light's
// polygon, as planes with the hull on one side (Haines 2000). All coordinates are relative to the light's
// centre, in double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "simd/simd_level.h"
#include "soft/area_light.h"

namespace tenebra {

inline constexpr int most_light_vertices = 14;

inline double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The light's polygon relative to its centre. Vertices are known within 2^-50 (reach + |centre|), which the
/// margins of the tests hold.
struct LightShape {
  explicit LightShape(const AreaLight& light);

  glm::dvec3 origin{0.0};  ///< the light's centre, world space
  glm::dvec3 normal{0.0};
  std::array<glm::dvec3, most_light_vertices> vertices{};
  int count = 0;
  double reach = 0;                ///< largest |coordinate|
  glm::dvec3 low{0.0}, high{0.0};  ///< box of the vertices
  /// Edge by edge: o, outwards in the light's plane, and o.x for its points x; 0 beyond the last.
  double across[3][16] = {}, at_edge[16] = {};
};

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

/// m.x <= limit for all x of the shaft; |m|_1 <= 1.
struct ShaftPlane {
  glm::dvec3 m{0.0};
  double limit = 0;
};

struct Shaft {
  Cell cell;
  const LightShape* light;
  glm::dvec3 low{0.0}, high{0.0};                          ///< box of the shaft, rounded outwards
  std::array<ShaftPlane, 7 + most_light_vertices> planes;  ///< those that cut off most come first
  int plane_count = 0;
};

/// Planes are made eight at a time, the same bits on every instruction set.
using ShaftMaker = Shaft (*)(const Cell& cell, const LightShape& light);
ShaftMaker shaft_maker(SimdLevel level);

}  // namespace tenebra
