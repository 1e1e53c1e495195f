#include "scene/view_basis.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace tenebra::scene {
namespace {

/// Unit vector of `v`, or zero if it has no direction. Scales first: squares of floats' extremes would
/// overflow.
glm::dvec3 direction_of(glm::dvec3 v) {
  const glm::dvec3 size = glm::abs(v);
  const double largest = std::max(size.x, std::max(size.y, size.z));
  if (!(largest > 0.0) || !std::isfinite(size.x + size.y + size.z)) return glm::dvec3(0.0);
  return glm::normalize(v / largest);
}

}  // namespace

glm::dmat3 view_basis(glm::dvec3 forward, glm::dvec3 up) {
  constexpr double parallel_sine = 1e-10;
  const glm::dvec3 given = direction_of(forward);
  const glm::dvec3 view = given == glm::dvec3(0.0) ? glm::dvec3(0, 0, -1) : given;
  for (const glm::dvec3 candidate : {direction_of(up), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)}) {
    const glm::dvec3 across = glm::cross(view, candidate);
    if (glm::length(across) < parallel_sine) continue;
    const glm::dvec3 right = glm::normalize(across);
    return {right, glm::cross(right, view), -view};
  }
  return glm::dmat3(1.0);  // unreachable: a unit vector is not parallel to both Y and Z
}

}  // namespace tenebra::scene
