#include "bake/sample.h"

#include <algorithm>
#include <cmath>

namespace tenebra::bake {

std::optional<glm::dvec3> weights_inside(const Triangle& corners, const glm::dvec3& weights,
                                         double margin_m) {
  const glm::dvec3 edges(glm::length(corners[2] - corners[1]), glm::length(corners[0] - corners[2]),
                         glm::length(corners[1] - corners[0]));  // edge i is opposite corner i
  const double twice_area = glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double perimeter = edges.x + edges.y + edges.z;
  if (!(twice_area > 0) || !std::isfinite(perimeter)) return std::nullopt;
  const double radius = twice_area / perimeter, margin = std::min(margin_m, 0.5 * radius);
  const glm::dvec3 distances = weights * twice_area / edges;
  double way = 0;  // 1: to the circle's middle
  for (int i = 0; i < 3; ++i)
    if (distances[i] < margin) way = std::max(way, (margin - distances[i]) / (radius - distances[i]));
  return glm::mix(weights, edges / perimeter, way);
}

}  // namespace tenebra::bake
