// The reference precision is there to compare with, not to be fast: its solvers are compiled for AVX2 and the
// baseline alone, which saves the half of their time to build. Include it before all of Highway.
#pragma once

#include <tenebra/simd_level.h>

#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_AVX3 | HWY_SSE4 | HWY_SSSE3)

namespace tenebra::soft {

/// The level whose code is taken in the place of `level`.
inline SimdLevel reference_level(SimdLevel level) {
  if (level == SimdLevel::automatic) level = best_simd_level();
  return level == SimdLevel::avx512 ? SimdLevel::avx2 : level;
}

}  // namespace tenebra::soft
