// Whether a matrix keeps right angles right.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace tenebra::math {

/// Whether the first three columns of `m` are at right angles, as those of a product of translation, rotation
/// and scale are: cosines of 1e-6 count as 0, as matrices in files have six or more digits. A column of zeros
/// is at right angles to all.
inline bool has_right_angles(const glm::dmat4& m) {
  constexpr double slack = 1e-6;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a(m[i]), b(m[(i + 1) % 3]);
    if (!(std::abs(glm::dot(a, b)) <= slack * glm::length(a) * glm::length(b))) return false;
  }
  return true;
}

}  // namespace tenebra::math
