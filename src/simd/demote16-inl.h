// Sixteen doubles as floats. Included once per target.
#if defined(TENEBRA_SIMD_DEMOTE16_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_DEMOTE16_INL_H_
#undef TENEBRA_SIMD_DEMOTE16_INL_H_
#else
#define TENEBRA_SIMD_DEMOTE16_INL_H_
#endif

#include "simd/double8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

/// Doubles as floats, rounded to nearest: eight and eight.
SIMD_INLINE Float16 demoted(Double8 first, Double8 second) {
  const Float8 low = demoted(first), high = demoted(second);
  Float16 p;
#if HWY_TARGET <= HWY_AVX3
  p.r[0] = hn::Combine(Float16::Tag(), high.r[0], low.r[0]);
#else
  for (int i = 0; i < Float8::registers; ++i) p.r[i] = low.r[i], p.r[i + Float8::registers] = high.r[i];
#endif
  return p;
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
