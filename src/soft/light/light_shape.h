// The light's polygon relative to its centre, as shafts and groups of points are measured against it. Places
// have a fourth, homogeneous coordinate, the light's `weight`: q - weight * p is the way from p to q; for a
// sun, of weight 0, it is the same from everywhere.
#pragma once

#include <tenebra/area_light.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace tenebra::soft {

inline constexpr int most_light_vertices = 14;

inline double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The light's polygon relative to its centre. Vertices are known within 2^-50 (reach + |centre|), which the
/// margins of the tests include.
struct LightShape {
  explicit LightShape(const AreaLight& light);

  glm::dvec3 origin{0.0};  ///< the light's centre, for a sun the world's origin; world space
  glm::dvec3 normal{0.0};
  double weight = 1;       ///< 0: a sun; its vertices are directions, within 2^-50
  glm::dvec3 middle{0.0};  ///< of the vertices
  std::array<glm::dvec3, most_light_vertices> vertices{};
  int count = 0;
  double reach = 0;                ///< largest |coordinate| of the vertices
  glm::dvec3 low{0.0}, high{0.0};  ///< box of the vertices
  /// Edge by edge: o, outwards in the light's plane, and o.x for its points x; 0 beyond the last.
  double across[3][16] = {}, at_edge[16] = {};

  bool at_infinity() const { return weight == 0; }
  /// Largest |coordinate| of its places.
  double place_reach() const { return weight * reach; }
};

}  // namespace tenebra::soft
