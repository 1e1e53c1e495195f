#include "ao/objects/surface_point.h"

#include <algorithm>
#include <cmath>

namespace tenebra::ao {

using glm::dvec3;
using glm::vec3;

vec3 face_normal(const ObjectShape& shape, std::size_t triangle) {
  const glm::uvec3 t = shape.triangles[triangle];
  const dvec3 a(shape.positions[t.x]);
  const dvec3 n = glm::cross(dvec3(shape.positions[t.y]) - a, dvec3(shape.positions[t.z]) - a);
  const double square = glm::dot(n, n);
  return square > 0 ? vec3(n / std::sqrt(square)) : vec3(0.0f);
}

double largest_coordinate(const ObjectShape& shape) {
  float largest = 0;
  for (const vec3& p : shape.positions)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

float surface_lift(double largest_coordinate) {
  return static_cast<float>(4 * 1.7320508 * 0x1p-24 * largest_coordinate);
}

}  // namespace tenebra::ao
