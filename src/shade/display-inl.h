// display.h at sixteen samples: the same operations in the same order, so the same bits. Included once per
// target.
#if defined(TENEBRA_SHADE_DISPLAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_DISPLAY_INL_H_
#undef TENEBRA_SHADE_DISPLAY_INL_H_
#else
#define TENEBRA_SHADE_DISPLAY_INL_H_
#endif

#include "shade/display.h"
#include "simd/float16-inl.h"
#include "simd/powers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// NaN: 0.
SIMD_INLINE Float16 zero_to(float most, Float16 value) {
  return select(lt(number(0.0f), value), min(value, number(most)), number(0.0f));
}
SIMD_INLINE Vector16 zero_to(float most, const Vector16& v) {
  return {zero_to(most, v.x), zero_to(most, v.y), zero_to(most, v.z)};
}

SIMD_INLINE Vector16 neutral_tone(const Vector16& color) {
  const Float16 one = number(1.0f);
  const Float16 least = min(min(color.x, color.y), color.z);
  const Float16 offset = select(lt(least, number(neutral::toe_end)),
                                least - number(neutral::toe) * (least * least), number(neutral::reflection));
  const Vector16 less{color.x - offset, color.y - offset, color.z - offset};
  const Float16 peak = max(max(less.x, less.y), less.z);
  const Mask<float, 16> bright = lt(number(neutral::start), peak);
  if (!any(bright)) return less;
  const Float16 compressed =
      one - number(neutral::room * neutral::room) / (peak + number(neutral::room - neutral::start));
  const Float16 kept = one / (number(neutral::desaturation) * (peak - compressed) + one);
  const Float16 scale = kept * (compressed / peak), white = compressed * (one - kept);
  return select3(bright, {scale * less.x + white, scale * less.y + white, scale * less.z + white}, less);
}

SIMD_INLINE Float16 row_times(const float (&row)[3], const Vector16& v) {
  return number(row[0]) * v.x + number(row[1]) * v.y + number(row[2]) * v.z;
}
SIMD_INLINE Vector16 rows_times(const float (&rows)[3][3], const Vector16& v) {
  return {row_times(rows[0], v), row_times(rows[1], v), row_times(rows[2], v)};
}
SIMD_INLINE Float16 aces_curve(Float16 x) {
  return (x * (x + number(aces::a)) - number(aces::b)) /
         (x * (number(aces::c) * x + number(aces::d)) + number(aces::e));
}
SIMD_INLINE Vector16 aces_tone(const Vector16& color) {
  const Vector16 film = rows_times(aces::input, color);
  return rows_times(aces::output, {aces_curve(film.x), aces_curve(film.y), aces_curve(film.z)});
}

SIMD_INLINE Vector16 shown(const Display& display, const Vector16& color) {
  const Vector16 exposed = number(display.exposure) * color;
  switch (display.tone) {
    case Tone::none:
      break;
    case Tone::neutral:
      return zero_to(1.0f, neutral_tone(zero_to(most_toned, exposed)));
    case Tone::aces:
      return zero_to(1.0f, aces_tone(zero_to(most_toned, exposed)));
  }
  return zero_to(1.0f, exposed);
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
