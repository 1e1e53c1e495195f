#include "points/contact_rule.h"

#include <algorithm>
#include <cmath>

namespace tenebra::points {

using glm::dvec3;
using glm::vec3;

double rounding_tolerance(const vec3 triangle[3]) {
  double largest = 0;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(static_cast<double>(triangle[k][axis])));
  }
  return contact_tau * largest;
}

double contact_threshold(const vec3 occluder[3], double tau_occluder, double tau_receiver) {
  const dvec3 e1 = dvec3(occluder[1]) - dvec3(occluder[0]), e2 = dvec3(occluder[2]) - dvec3(occluder[0]);
  const dvec3 n(e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x);
  return (tau_occluder + tau_receiver) * std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

}  // namespace tenebra::points
