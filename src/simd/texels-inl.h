// Places in sixteen pictures, and the four values of each pixel there. Included once per target.
#if defined(TENEBRA_SIMD_TEXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_TEXELS_INL_H_
#undef TENEBRA_SIMD_TEXELS_INL_H_
#else
#define TENEBRA_SIMD_TEXELS_INL_H_
#endif

#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

/// The greatest whole number that is not above, lane by lane.
template <int N>
SIMD_INLINE Pack<float, N> floor(Pack<float, N> a) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Floor(a.r[i]);
  return a;
}

/// Eight whole numbers of 16 bits, as floats; any alignment.
SIMD_INLINE Float8 load_whole16(const std::uint16_t* from) {
  const hn::Rebind<std::uint16_t, Float8::Tag> narrow;
  const hn::Rebind<std::int32_t, Float8::Tag> wide;
  Float8 p;
  for (int i = 0; i < Float8::registers; ++i) {
    const auto whole = hn::PromoteTo(wide, hn::LoadU(narrow, from + i * Float8::width));
    p.r[i] = hn::ConvertTo(Float8::Tag(), whole);
  }
  return p;
}

/// Lanes 0 to 3, and 4 to 7.
SIMD_INLINE Float4 lower_half(Float8 a) {
  Float4 p;
#if HWY_TARGET <= HWY_AVX2
  p.r[0] = hn::LowerHalf(Float4::Tag(), a.r[0]);
#else
  for (int i = 0; i < Float4::registers; ++i) p.r[i] = a.r[i];
#endif
  return p;
}
SIMD_INLINE Float4 upper_half(Float8 a) {
  Float4 p;
#if HWY_TARGET <= HWY_AVX2
  p.r[0] = hn::UpperHalf(Float4::Tag(), a.r[0]);
#else
  for (int i = 0; i < Float4::registers; ++i) p.r[i] = a.r[Float4::registers + i];
#endif
  return p;
}

/// The inverse of store_fours: value c of lane k stands at from[4 k + c].
SIMD_INLINE void load_fours(const float* from, Float16 (&to)[4]) {
  for (int i = 0; i < Float16::registers; ++i)
    hn::LoadInterleaved4(Float16::Tag(), from + 4 * i * Float16::width, to[0].r[i], to[1].r[i], to[2].r[i],
                         to[3].r[i]);
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
