// Logarithms and powers of two of sixteen values, and the functions that they need. Nothing is fused: the
// same bits on every instruction set. Included once per target.
#if defined(TENEBRA_SIMD_POWERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_POWERS_INL_H_
#undef TENEBRA_SIMD_POWERS_INL_H_
#else
#define TENEBRA_SIMD_POWERS_INL_H_
#endif

#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

SIMD_INLINE Float16 number(float value) {
  return broadcast<Float16>(value);
}
SIMD_INLINE Float16 clamped(Float16 value, float least, float most) {
  return min(max(value, number(least)), number(most));
}

/// The logarithm of normal positive values; error below 2e-7 beside that of the result's rounding.
SIMD_INLINE Float16 log2_of(Float16 x) {
  const Int16 bits = bits_of(x);
  const Int16 exponent = shift_right<23>(bits - broadcast<Int16>(0x3f3504f3));  // from sqrt(1/2) on
  const Float16 mantissa = float_of_bits(bits - shift_left<23>(exponent));
  const Float16 z = (mantissa - number(1.0f)) / (mantissa + number(1.0f)), s = z * z;
  const Float16 series =
      number(1.0f) +
      s * (number(1 / 3.0f) + s * (number(1 / 5.0f) + s * (number(1 / 7.0f) + s * number(1 / 9.0f))));
  return to_float(exponent) + number(2.885390082f) * z * series;  // 2 / ln 2
}
/// 0 below -126; relative error below 3e-7.
SIMD_INLINE Float16 exp2_of(Float16 y) {
  const Float16 held = clamped(y, -126.0f, 126.0f);
  const Int16 whole = truncate(held + copy_sign(number(0.5f), held));
  const Float16 x = (held - to_float(whole)) * number(0.69314718f);
  const Float16 power =
      number(1.0f) +
      x * (number(1.0f) +
           x * (number(1 / 2.0f) +
                x * (number(1 / 6.0f) +
                     x * (number(1 / 24.0f) + x * (number(1 / 120.0f) + x * number(1 / 720.0f))))));
  const Float16 scale = float_of_bits(shift_left<23>(whole + broadcast<Int16>(127)));
  return select(lt(y, number(-126.0f)), number(0.0f), power * scale);
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
