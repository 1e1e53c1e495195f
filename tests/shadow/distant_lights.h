// Directions of distant lights, for the tests of what they do.
#pragma once

#include <cmath>

#include <tenebra/simd_level.h>
#include "support/parameter_names.h"
#include "support/seeded_random.h"

namespace tenebra::testing {

inline constexpr SimdLevel simd_levels[] = {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2,
                                            SimdLevel::avx512};

/// 0: any; 1: along an axis; else nearly so.
inline glm::dvec3 direction_of_kind(int kind, Random& random) {
  if (kind == 0) return random.direction();
  glm::dvec3 axis(0);
  axis[static_cast<int>(random.index(3))] = random.chance(0.5) ? 1 : -1;
  if (kind == 1) return axis;
  return glm::normalize(axis + std::pow(10.0, random.in(-9, -2)) * random.in_cube(1));
}

}  // namespace tenebra::testing
