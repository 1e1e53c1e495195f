#include "shadow/rays/direction_keys.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/rays/direction_keys.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

constexpr int curve_bits = 14;

// Hilbert index of cells x, y, highest bits first. `swapped` and `flipped` are all ones where from here on
// the curve runs with x and y exchanged, or through their complements.
SIMD_INLINE Int16 hilbert_index(Int16 x, Int16 y) {
  const Int16 zero = broadcast<Int16>(0), ones = broadcast<Int16>(-1), one = broadcast<Int16>(1);
  Int16 swapped = zero, flipped = zero, index = zero;
  x = shift_left<32 - curve_bits>(x);
  y = shift_left<32 - curve_bits>(y);
  for (int level = 0; level < curve_bits; ++level) {
    const Int16 x_bit = shift_right<31>(x), y_bit = shift_right<31>(y);  // 0 or all ones
    const Int16 exchange = (x_bit ^ y_bit) & swapped;
    const Int16 rx = x_bit ^ exchange ^ flipped, ry = y_bit ^ exchange ^ flipped;
    // digit = (3 rx) xor ry
    index = shift_left<2>(index) | ((rx & broadcast<Int16>(3)) ^ (ry & one));
    swapped = swapped ^ (ry ^ ones);
    flipped = flipped ^ ((ry ^ ones) & rx);
    x = shift_left<1>(x);
    y = shift_left<1>(y);
  }
  return index;
}

SIMD_INLINE Int16 cell_of(Float16 coordinate) {
  constexpr float half = 1 << (curve_bits - 1);
  const Float16 scaled = mul_add(coordinate, broadcast<Float16>(half), broadcast<Float16>(half));
  return truncate(min(max(scaled, broadcast<Float16>(0.0f)), broadcast<Float16>(2 * half - 1)));
}

void direction_keys(const float* px, const float* py, const float* pz, std::uint32_t* keys) {
  const Float16 x = load<Float16>(px), y = load<Float16>(py), z = load<Float16>(pz);
  const Float16 ax = abs(x), ay = abs(y), az = abs(z);
  const Float16 largest = max(ax, max(ay, az));
  // Major axis: x, else y, else z; u and v are the next two in cyclic order.
  const Float16 major = select_le(largest, ax, x, select_le(largest, ay, y, z));
  const Float16 u = select_le(largest, ax, y, select_le(largest, ay, z, x));
  const Float16 v = select_le(largest, ax, z, select_le(largest, ay, x, y));
  const Int16 axis = select_le(largest, ax, broadcast<Int16>(0),
                               select_le(largest, ay, broadcast<Int16>(2), broadcast<Int16>(4)));
  const Int16 face =
      axis | select_le(broadcast<Float16>(0.0f), major, broadcast<Int16>(0), broadcast<Int16>(1));
  const Int16 index = hilbert_index(cell_of(u / largest), cell_of(v / largest));
  std::int32_t out[16];
  store(shift_left<2 * curve_bits>(face) | index, out);
  std::copy(out, out + 16, keys);
}

}  // namespace

DirectionKeys direction_keys_kernel() {
  return direction_keys;
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

DirectionKeys direction_keys_kernel(SimdLevel level) {
  return TENEBRA_DISPATCH(level, direction_keys_kernel)();
}

}  // namespace tenebra::shadow
#endif
