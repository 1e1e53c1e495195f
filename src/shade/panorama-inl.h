// What is seen of a panorama in sixteen directions. Nothing is fused: the same bits on every instruction set.
// Included once per target.
#if defined(TENEBRA_SHADE_PANORAMA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SHADE_PANORAMA_INL_H_
#undef TENEBRA_SHADE_PANORAMA_INL_H_
#else
#define TENEBRA_SHADE_PANORAMA_INL_H_
#endif

#include "shade/diffuse-inl.h"
#include "shade/panorama.h"
#include "simd/powers-inl.h"
#include "simd/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shade::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// The arctangent of 0 to 1. tan(a) = t has tan(a / 2) = t / (1 + sqrt(1 + t t)): twice, so that t is at most
/// 0.199, where the series errs by 4 * 0.199^11 / 11 < 1e-8; roundings are below 1e-6.
SIMD_INLINE Float16 arctangent(Float16 t) {
  const Float16 one = number(1.0f);
  for (int i = 0; i < 2; ++i) t = t / (one + sqrt(one + t * t));
  const Float16 s = t * t;
  const Float16 series =
      one - s * (number(1 / 3.0f) - s * (number(1 / 5.0f) - s * (number(1 / 7.0f) - s * number(1 / 9.0f))));
  return number(4.0f) * t * series;
}
/// The angle of (x, y) from the x axis, -pi to pi; 0 for (0, 0).
SIMD_INLINE Float16 angle_of(Float16 y, Float16 x) {
  constexpr float pi = 3.14159265f;
  const Float16 zero = number(0.0f), along = abs(x), across = abs(y);
  const Float16 longer = max(along, across);
  const Float16 shorter = min(along, across);
  const Float16 acute =
      arctangent(select(lt(zero, longer), shorter / select(lt(zero, longer), longer, number(1.0f)), zero));
  const Float16 upper = select(lt(along, across), number(pi / 2) - acute, acute);
  return copy_sign(select(lt(x, zero), number(pi) - upper, upper), y);
}

/// Places on one level, and what stands around them, for sixteen samples.
struct PanoramaCorners {
  alignas(64) std::int32_t first[16];
  alignas(64) std::int32_t stride[16];
  alignas(64) float across[16], down[16];
};

/// `u`, `v`: 0 to 1. Whatever they are, the pixels found are in the level.
SIMD_INLINE void find_panorama_corners(const Panorama& picture, Int16 level, Float16 u, Float16 v,
                                       PanoramaCorners& out) {
  const Int16 one = broadcast<Int16>(1), least = broadcast<Int16>(-1);
  const Int16 width = max(shift_right(broadcast<Int16>(picture.width), level), one),
              height = max(shift_right(broadcast<Int16>(picture.height), level), one);
  const Float16 x = u * to_float(width) - number(0.5f), y = v * to_float(height) - number(0.5f);
  const Float16 column = floor(x), row = floor(y);
  const Int16 stride = width + broadcast<Int16>(2);
  const Int16 held_column = min(max(truncate(column), least), width - one),
              held_row = min(max(truncate(row), least), height - one);
  store(x - column, out.across);
  store(y - row, out.down);
  store(stride, out.stride);
  store(gather<std::int32_t>(picture.starts.data(), shift_left<2>(level)) + held_row * stride + held_column,
        out.first);
}

SIMD_INLINE Float4 between_pixels(const Panorama& picture, const PanoramaCorners& corners, std::size_t k) {
  const auto at = [&](std::int32_t i) {
    return load<Float4>(&picture.pixels[static_cast<std::size_t>(i)].x);
  };
  const std::int32_t upper = corners.first[k], lower = upper + corners.stride[k];
  const Float4 across = broadcast<Float4>(corners.across[k]);
  const Float4 top = at(upper) + across * (at(upper + 1) - at(upper)),
               bottom = at(lower) + across * (at(lower + 1) - at(lower));
  return top + broadcast<Float4>(corners.down[k]) * (bottom - top);
}

/// In unit directions, through lobes of GGX roughness `roughness` (the square root of its alpha): from the
/// copy whose pixels are as wide as the lobe, 2 alpha radians.
inline Vector16 seen(const Panorama& picture, const Vector16& direction, Float16 roughness) {
  constexpr float pi = 3.14159265f;
  const Float16 zero = number(0.0f), one = number(1.0f);
  const Float16 u = angle_of(direction.x, zero - direction.z) * number(0.5f / pi) + number(0.5f);
  const Float16 level_length = sqrt(direction.x * direction.x + direction.z * direction.z);
  const Float16 v = angle_of(level_length, direction.y) * number(1 / pi);
  const Float16 pixels = roughness * roughness * number(static_cast<float>(picture.width) / pi);
  const Int16 last = broadcast<Int16>(picture.level_count - 1);
  const Float16 detail =
      min(log2_of(select(lt(one, pixels), min(pixels, number(1e9f)), one)), to_float(last));
  const Int16 lower = truncate(detail);
  alignas(64) float part[16], found[64];
  store(detail - to_float(lower), part);
  PanoramaCorners sharp, blurred;
  find_panorama_corners(picture, lower, u, v, sharp);
  find_panorama_corners(picture, min(lower + broadcast<Int16>(1), last), u, v, blurred);
  for (std::size_t k = 0; k < 16; ++k) {
    Float4 value = between_pixels(picture, sharp, k);
    if (part[k] > 0)
      value = value + broadcast<Float4>(part[k]) * (between_pixels(picture, blurred, k) - value);
    store(value, found + 4 * k);
  }
  Float16 channels[4];
  load_fours(found, channels);
  return {channels[0], channels[1], channels[2]};
}

}  // namespace tenebra::shade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
