// The data of a Geometry.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::query {

/// The largest coordinate of vertices, points and lights: beyond it, products leave the range of floats.
inline constexpr float largest_coordinate = 1e18f;

struct GeometryData {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint8_t> casts_shadow;  ///< empty: all
  std::uint64_t revision = 0;              ///< counts moves
  double diagonal = 0;                     ///< of the vertices' box, metres
  glm::dvec3 origin{0.0};                  ///< in the caller's coordinates
};

inline TriangleView view_of(const GeometryData& data) {
  return {.positions = data.positions,
          .triangles = data.triangles,
          .casts_shadow = data.casts_shadow,
          .parts = {}};
}

}  // namespace tenebra::query
