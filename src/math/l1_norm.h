// The L1 norm, in which the bounds on rounding are stated.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace tenebra::math {

inline double l1_norm(const glm::dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace tenebra::math
