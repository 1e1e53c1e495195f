#include "texture/sampler.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/sampler.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/powers-inl.h"
#include "simd/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::texture::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Lanes = Mask<float, 16>;

/// What sixteen pixels see of level 0, in its pixels.
struct Ellipses {
  Float16 major, minor;
  Float16 axis_u, axis_v;  ///< from end to end of the longer axis, in coordinates of the picture
};

/// A step in pixels of level 0, at most 1e9: squares of squares stay finite. No number counts as 1e9.
SIMD_INLINE Float16 held_step(const float* step, float size) {
  const Float16 most = number(1e9f), x = load<Float16>(step) * number(size);
  return select(le(abs(x), most), x, copy_sign(most, x));
}

SIMD_INLINE Ellipses ellipses_of(const TexturePlaces& at, std::size_t i, float width, float height) {
  const Float16 x1 = held_step(at.by_x[0] + i, width), y1 = held_step(at.by_x[1] + i, height),
                x2 = held_step(at.by_y[0] + i, width), y2 = held_step(at.by_y[1] + i, height);
  const Float16 a = x1 * x1 + x2 * x2, b = x1 * y1 + x2 * y2, c = y1 * y1 + y2 * y2;
  const Float16 half = number(0.5f) * (a - c), root = sqrt(half * half + b * b);
  const Float16 zero = number(0.0f), one = number(1.0f);
  const Float16 major = sqrt(number(0.5f) * (a + c) + root);
  const Lanes across = le(c, a);
  const Float16 along_u = select(across, half + root, b), along_v = select(across, b, root - half);
  const Float16 length = sqrt(along_u * along_u + along_v * along_v);
  const Lanes has_axis = lt(zero, length);
  const Float16 scale = select(has_axis, major / select(has_axis, length, one), zero);
  return {major, abs(x1 * y2 - y1 * x2) / max(major, one), scale * along_u * number(1 / width),
          scale * along_v * number(1 / height)};
}

/// How sixteen pixels look a texture up.
struct Plan {
  Float16 u, v;            ///< before folding
  Float16 step_u, step_v;  ///< from end to end of the places
  Float16 taps, inverse;   ///< number of places, and its inverse
  Int16 lower, upper;      ///< levels
  Float16 part;            ///< share of the upper one
  Float16 half;            ///< 0 where the nearest pixel is taken, 0.5 where it is between four
};

SIMD_INLINE Plan plan_of(const MipTexture& texture, const TextureMap& map, const TexturePlaces& at,
                         std::size_t i) {
  const auto width = static_cast<float>(texture.width()), height = static_cast<float>(texture.height());
  const Float16 zero = number(0.0f), one = number(1.0f);
  const Ellipses seen = ellipses_of(at, i, width, height);
  const Float16 u = load<Float16>(at.at[0] + i), v = load<Float16>(at.at[1] + i);
  const Lanes usable = lt(abs(u), number(1e9f)) & lt(abs(v), number(1e9f));
  const Lanes smaller = usable & lt(one, seen.major);
  Plan plan;
  plan.u = select(usable, u, number(0.5f / width));
  plan.v = select(usable, v, number(0.5f / height));
  plan.taps = one;
  if (map.minify == Filter::linear && map.mip != MipFilter::none && texture.level_count() > 1) {
    // The least whole number that is not below ratio - 1e-3.
    const Float16 ratio = seen.major / max(seen.minor, one) - number(1e-3f);
    const Float16 taps = number(0.0f) - floor(number(0.0f) - min(ratio, number(most_taps)));
    plan.taps = select(smaller, max(taps, one), one);
  }
  plan.inverse = one / plan.taps;
  const Lanes several = lt(one, plan.taps);
  plan.step_u = select(several, seen.axis_u, zero);
  plan.step_v = select(several, seen.axis_v, zero);
  Float16 level = zero;
  if (map.mip != MipFilter::none) {
    const auto last = static_cast<float>(texture.level_count() - 1);
    level = min(log2_of(select(smaller, max(seen.major * plan.inverse, one), one)), number(last));
  }
  if (map.mip == MipFilter::nearest) level = floor(level + number(0.5f));
  plan.lower = truncate(level);
  plan.part = level - to_float(plan.lower);
  const Int16 last = broadcast<Int16>(texture.level_count() - 1);
  plan.upper = min(plan.lower + broadcast<Int16>(1), last);
  const auto half_of = [](Filter filter) { return number(filter == Filter::nearest ? 0.0f : 0.5f); };
  plan.half = select(smaller, half_of(map.minify), half_of(map.magnify));
  return plan;
}

/// One level as sixteen samples have it.
struct Levels {
  Int16 start, stride;
  Float16 width, height;
};
SIMD_INLINE Levels levels_of(const MipTexture& texture, Int16 level) {
  const Int16 one = broadcast<Int16>(1);
  const Int16 width = max(shift_right(broadcast<Int16>(texture.width()), level), one),
              height = max(shift_right(broadcast<Int16>(texture.height()), level), one);
  return {gather<std::int32_t>(texture.starts().data(), shift_left<2>(level)), width + broadcast<Int16>(2),
          to_float(width), to_float(height)};
}

/// Where the four pixels around sixteen places of a level stand, and where the places lie between them.
struct Corners {
  alignas(64) std::int32_t first[16];  ///< number of the upper left one
  alignas(64) float across[16];        ///< 0 at the left ones, 1 at the right ones
  alignas(64) float down[16];          ///< 0 at the upper ones
};

/// The corners of all of a sample's places on one level.
struct LevelCorners {
  alignas(64) std::int32_t stride[16];
  Corners of_tap[most_taps];
};

/// What sixteen samples read.
struct Reads {
  alignas(64) std::int32_t taps[16];
  alignas(64) float part[16];   ///< share of the upper level
  alignas(64) float scale[16];  ///< what a sum over all places is multiplied with
  LevelCorners lower, upper;    ///< `upper`: where `part` is not 0
};

/// The coordinate in the picture, 0 to 1, that `x` stands for.
SIMD_INLINE Float16 folded(Float16 x, Wrap mode) {
  if (mode == Wrap::clamp_to_edge) return clamped(x, 0.0f, 1.0f);
  if (mode == Wrap::repeat) return x - floor(x);
  const Float16 within = x - number(2.0f) * floor(number(0.5f) * x);
  return min(within, number(2.0f) - within);
}

SIMD_INLINE void find_corners(const Levels& level, Float16 u, Float16 v, Float16 half, Corners& out) {
  const Float16 one = number(1.0f);
  const Float16 x = u * level.width - half, y = v * level.height - half;
  // Where half is 0, x may be the width: that is the last pixel's edge.
  const Float16 column = min(floor(x), level.width - one), row = min(floor(y), level.height - one);
  const Lanes between = lt(number(0.0f), half);
  store(select(between, x - column, number(0.0f)), out.across);
  store(select(between, y - row, number(0.0f)), out.down);
  store(level.start + truncate(row) * level.stride + truncate(column), out.first);
}

SIMD_INLINE Float4 between_corners(const std::uint16_t* texels, const LevelCorners& level, int tap,
                                   std::size_t k) {
  const Corners& corners = level.of_tap[tap];
  const std::uint16_t* const upper = texels + 4 * std::ptrdiff_t{corners.first[k]};
  const std::uint16_t* const lower = upper + 4 * std::ptrdiff_t{level.stride[k]};
  const Float8 top = load_whole16(upper), bottom = load_whole16(lower);
  const Float8 both = top + broadcast<Float8>(corners.down[k]) * (bottom - top);
  const Float4 left = lower_half(both);
  return left + broadcast<Float4>(corners.across[k]) * (upper_half(both) - left);
}

void plan_reads(const MipTexture& texture, const TextureMap& map, const TexturePlaces& at, std::size_t i,
                Reads& out) {
  const Plan plan = plan_of(texture, map, at, i);
  store(truncate(plan.taps), out.taps);
  store(plan.part, out.part);
  store(plan.inverse * number(1 / MipTexture::one), out.scale);
  const Levels lower = levels_of(texture, plan.lower);
  store(lower.stride, out.lower.stride);
  const bool two_levels = any(lt(number(0.0f), plan.part));
  const Levels upper = two_levels ? levels_of(texture, plan.upper) : lower;
  store(upper.stride, out.upper.stride);
  const int taps = static_cast<int>(reduce_max(plan.taps));
  for (int tap = 0; tap < taps; ++tap) {
    const Float16 along = number(static_cast<float>(tap) + 0.5f) * plan.inverse - number(0.5f);
    const Float16 u = folded(plan.u + along * plan.step_u, texture.wrap_u()),
                  v = folded(plan.v + along * plan.step_v, texture.wrap_v());
    find_corners(lower, u, v, plan.half, out.lower.of_tap[tap]);
    if (two_levels) find_corners(upper, u, v, plan.half, out.upper.of_tap[tap]);
  }
}

void read(const std::uint16_t* texels, const Reads& reads, std::size_t i, std::size_t count,
          TextureValues& out) {
  alignas(64) float found[64] = {};
  for (std::size_t k = 0; k < count; ++k) {
    const int taps = reads.taps[k];
    const float part = reads.part[k];
    Float4 sharp = between_corners(texels, reads.lower, 0, k);
    for (int tap = 1; tap < taps; ++tap) sharp = sharp + between_corners(texels, reads.lower, tap, k);
    if (part > 0) {
      Float4 blurred = between_corners(texels, reads.upper, 0, k);
      for (int tap = 1; tap < taps; ++tap) blurred = blurred + between_corners(texels, reads.upper, tap, k);
      sharp = sharp + broadcast<Float4>(part) * (blurred - sharp);
    }
    store(broadcast<Float4>(reads.scale[k]) * sharp, found + 4 * k);
  }
  Float16 channels[4];
  load_fours(found, channels);
  for (int c = 0; c < 4; ++c) store(min(channels[c], number(1.0f)), out.channel[c] + i);
}

void sample(const MipTexture& texture, const TextureMap& map, const TexturePlaces& at, std::size_t first,
            std::size_t count, TextureValues& out) {
  // The next reads are planned before these are done, so that no read waits for its address.
  Reads reads[2];
  if (count > 0) plan_reads(texture, map, at, first, reads[0]);
  for (std::size_t i = 0, turn = 0; i < count; i += 16, turn ^= 1) {
    if (i + 16 < count) plan_reads(texture, map, at, first + i + 16, reads[turn ^ 1]);
    read(texture.texels(), reads[turn], first + i, std::min<std::size_t>(count - i, 16), out);
  }
}

}  // namespace

Sampler sampler() {
  return sample;
}

}  // namespace tenebra::texture::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::texture {

Sampler sampler(SimdLevel level) {
  return TENEBRA_DISPATCH(level, sampler)();
}

}  // namespace tenebra::texture
#endif
