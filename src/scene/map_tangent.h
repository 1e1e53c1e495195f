// The direction of a map on a triangle.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace tenebra::scene {

/// xyz: of unit length in the plane of the edges `e1` and `e2`, where the map's first coordinate grows; w:
/// the sign of the map's y axis, which is up in the picture, where the second coordinate falls, beside a
/// normal on the side of cross(e1, e2). `second` and `third`: coordinates of the edges' ends less those of
/// their start. Zeros where the map has no area there. Doubles; rounded.
inline glm::dvec4 map_tangent(const glm::dvec3& e1, const glm::dvec3& e2, const glm::dvec2& second,
                              const glm::dvec2& third) {
  const double area = second.x * third.y - third.x * second.y;
  const glm::dvec3 along = (area < 0 ? -1.0 : 1.0) * (third.y * e1 - second.y * e2);
  const double square = glm::dot(along, along);
  if (area == 0 || !(square > 0) || !std::isfinite(square)) return glm::dvec4(0.0);
  return {along / std::sqrt(square), area < 0 ? 1.0 : -1.0};
}

}  // namespace tenebra::scene
