#include "shadow/rays/ray_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/rays/ray_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

constexpr int curve_bits = 14;

// Hilbert index of cells x, y, highest bits first. `swapped` and `flipped` are all ones where from here on
// the curve runs with x and y exchanged, or through their complements.
HWY_INLINE Int16 hilbert_index(Int16 x, Int16 y) {
  const Int16 zero = splat<Int16>(0), ones = splat<Int16>(-1), one = splat<Int16>(1);
  Int16 swapped = zero, flipped = zero, index = zero;
  x = shift_left<32 - curve_bits>(x);
  y = shift_left<32 - curve_bits>(y);
  for (int level = 0; level < curve_bits; ++level) {
    const Int16 x_bit = shift_right<31>(x), y_bit = shift_right<31>(y);  // 0 or all ones
    const Int16 exchange = (x_bit ^ y_bit) & swapped;
    const Int16 rx = x_bit ^ exchange ^ flipped, ry = y_bit ^ exchange ^ flipped;
    // digit = (3 rx) xor ry
    index = shift_left<2>(index) | ((rx & splat<Int16>(3)) ^ (ry & one));
    swapped = swapped ^ (ry ^ ones);
    flipped = flipped ^ ((ry ^ ones) & rx);
    x = shift_left<1>(x);
    y = shift_left<1>(y);
  }
  return index;
}

HWY_INLINE Int16 cell_of(Float16 coordinate) {
  constexpr float half = 1 << (curve_bits - 1);
  const Float16 scaled = multiply_add(coordinate, splat<Float16>(half), splat<Float16>(half));
  return truncate(min(max(scaled, splat<Float16>(0.0f)), splat<Float16>(2 * half - 1)));
}

void direction_keys(const float* px, const float* py, const float* pz, std::uint32_t* keys) {
  const Float16 x = load<Float16>(px), y = load<Float16>(py), z = load<Float16>(pz);
  const Float16 ax = absolute(x), ay = absolute(y), az = absolute(z);
  const Float16 largest = max(ax, max(ay, az));
  // Major axis: x, else y, else z; u and v are the next two in cyclic order.
  const Float16 major = where_not_above(largest, ax, x, where_not_above(largest, ay, y, z));
  const Float16 u = where_not_above(largest, ax, y, where_not_above(largest, ay, z, x));
  const Float16 v = where_not_above(largest, ax, z, where_not_above(largest, ay, x, y));
  const Int16 axis = where_not_above(largest, ax, splat<Int16>(0),
                                     where_not_above(largest, ay, splat<Int16>(2), splat<Int16>(4)));
  const Int16 face = axis | where_not_above(splat<Float16>(0.0f), major, splat<Int16>(0), splat<Int16>(1));
  const Int16 index = hilbert_index(cell_of(u / largest), cell_of(v / largest));
  std::int32_t out[16];
  store(shift_left<2 * curve_bits>(face) | index, out);
  std::copy(out, out + 16, keys);
}

// Chord cone around sixteen directions. In units of the packet's reach, so that squares stay in range. A
// float position base + q is off by 2 sqrt(3) u (|p| + r) at most, its direction after normalising by 12u +
// 4u r / |p|; lengths by a factor 1 +- 16u and 4u r.
ConeNode cone_around(const RayPacket& packet) {
  constexpr float u = 0x1p-24f;
  const float inverse = 1 / packet.reach;
  const Float16 scale = splat<Float16>(inverse);
  const Pack3<Float16> p{
      (splat<Float16>(static_cast<float>(packet.base_x)) + load<Float16>(packet.qx)) * scale,
      (splat<Float16>(static_cast<float>(packet.base_y)) + load<Float16>(packet.qy)) * scale,
      (splat<Float16>(static_cast<float>(packet.base_z)) + load<Float16>(packet.qz)) * scale};
  const Float16 length = square_root(dot(p, p));
  const float shortest = least(length), longest = greatest(length);
  const float r = packet.radius * inverse;

  ConeNode node;
  node.near = std::max(0.0f, (shortest * (1 - 16 * u) - 4 * u * r) * packet.reach * (1 - 4 * u));
  node.far = (longest * (1 + 16 * u) + 4 * u * r) * packet.reach * (1 + 4 * u);
  node.w = glm::vec3(1, 0, 0);
  node.c = 4;                            // more than any chord: bounds nothing, but is finite
  if (!(shortest > 1e-6f)) return node;  // a ray next to the light, in a packet that is not

  const Pack3<Float16> d{p.x / length, p.y / length, p.z / length};
  const glm::vec3 centre(least(d.x) + greatest(d.x), least(d.y) + greatest(d.y), least(d.z) + greatest(d.z));
  const float centre_length = std::sqrt(centre.x * centre.x + centre.y * centre.y + centre.z * centre.z);
  if (centre_length > 1e-3f) node.w = centre / centre_length;
  const Pack3<Float16> apart{d.x - splat<Float16>(node.w.x), d.y - splat<Float16>(node.w.y),
                             d.z - splat<Float16>(node.w.z)};
  const float widest = std::sqrt(greatest(dot(apart, apart)));
  node.c = std::min(node.c, (1 + 8 * u) * widest + 12 * u + 4 * u * r / shortest);
  return node;
}

}  // namespace

RayKernels ray_kernels() {
  return {direction_keys, cone_around};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

RayKernels ray_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, ray_kernels)();
}

}  // namespace tenebra::shadow
#endif
