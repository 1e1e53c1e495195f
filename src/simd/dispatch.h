// The one way from a vector level to the code that was compiled for it. Include it after Highway's
// foreach_target.h, use it below `#if HWY_ONCE`:
//
//   Kernels kernels(SimdLevel level) { return TENEBRA_DISPATCH(level, kernels)(); }
//
// calls `kernels()` of the nested namespace that Highway made for the instruction set of `level`.
#pragma once

#include <hwy/highway.h>

#include <tenebra/simd_level.h>
#include <type_traits>

namespace tenebra::simd {

/// The function of `level` (automatic: of the best level of this machine); that of the next lower level which
/// this file was compiled for, where it has none for it.
template <class Function>
Function dispatched(SimdLevel level, Function baseline, std::type_identity_t<Function> sse4,
                    std::type_identity_t<Function> avx2, std::type_identity_t<Function> avx512) {
  if (level == SimdLevel::automatic) level = best_simd_level();
  Function chosen = nullptr;
  if (level == SimdLevel::avx512) chosen = avx512;
  if (chosen == nullptr && level >= SimdLevel::avx2) chosen = avx2;
  if (chosen == nullptr && level >= SimdLevel::sse4) chosen = sse4;
  return chosen != nullptr ? chosen : baseline;
}

}  // namespace tenebra::simd

#if HWY_TARGETS & HWY_AVX3
#define TENEBRA_OF_AVX512(function) &N_AVX3::function
#else
#define TENEBRA_OF_AVX512(function) nullptr
#endif
#if HWY_TARGETS & HWY_AVX2
#define TENEBRA_OF_AVX2(function) &N_AVX2::function
#else
#define TENEBRA_OF_AVX2(function) nullptr
#endif
#if HWY_TARGETS & HWY_SSE4
#define TENEBRA_OF_SSE4(function) &N_SSE4::function
#elif HWY_TARGETS & HWY_NEON  // the level of the same width
#define TENEBRA_OF_SSE4(function) &N_NEON::function
#else
#define TENEBRA_OF_SSE4(function) nullptr
#endif

#define TENEBRA_DISPATCH(level, function)                                                      \
  ::tenebra::simd::dispatched(level, HWY_STATIC_DISPATCH(function), TENEBRA_OF_SSE4(function), \
                              TENEBRA_OF_AVX2(function), TENEBRA_OF_AVX512(function))
