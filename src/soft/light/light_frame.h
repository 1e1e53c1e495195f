// The light as the solvers see it: two coordinates on its plane, in units of its size.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include <tenebra/area_light.h>

namespace tenebra::soft {

/// A point of the light's plane is origin + u ex + v ey; the light's vertices have |u|, |v| <= 1. World
/// space, metres.
struct LightFrame {
  glm::dvec3 origin{0.0}, ex{0.0}, ey{0.0},
      normal{0.0};                  ///< ex, ey orthogonal and of one length; normal unit
  std::vector<glm::dvec2> polygon;  ///< counter-clockwise seen from the front
  double area = 0;                  ///< of the polygon, units of the light squared
  /// The fourth, homogeneous coordinate of all its places: 1, or 0 for a sun, whose places are directions.
  double weight = 1;

  glm::dvec3 point(glm::dvec2 at) const { return origin + at.x * ex + at.y * ey; }
  /// From `from` to the origin; for a sun the same from everywhere.
  glm::dvec3 way_from(const glm::dvec3& from) const { return origin - weight * from; }
};

LightFrame light_frame(const AreaLight& light);

/// The line (u, v, w) on the light's plane where a plane of normal `n` meets it, positive where n points;
/// `to_origin` goes from any point of that plane to the light's origin.
inline glm::dvec3 line_of_plane(const LightFrame& light, const glm::dvec3& n, const glm::dvec3& to_origin) {
  return {glm::dot(n, light.ex), glm::dot(n, light.ey), glm::dot(n, to_origin)};
}

}  // namespace tenebra::soft
