#include "points/visible_run.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "points/visible_run.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Double8 = Pack<double, 8>;
using Vector8 = Pack3<Double8>;

SIMD_INLINE Vector8 same(const glm::dvec3& v) {
  return splat3<Double8>(v.x, v.y, v.z);
}
/// Not fused, in the order of glm::dot.
SIMD_INLINE Double8 plain_dot(const Vector8& a, const Vector8& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
SIMD_INLINE Vector8 scaled(Double8 s, const Vector8& v) {
  return {s * v.x, s * v.y, s * v.z};
}
SIMD_INLINE Vector8 sum(const Vector8& a, const Vector8& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

std::uint32_t eight(const Receiver& r, const PixelRow& row, std::size_t x, glm::dvec3 points[8]) {
  double places[8];
  for (std::size_t i = 0; i < 8; ++i) places[i] = static_cast<double>(x + i) + 0.5;
  const Vector8 across = sum(scaled(load<Double8>(places), same(row.dx)), same(row.row));
  const Vector8 direction = sum(same(row.d0), across);
  const Vector8 eye = same(row.eye), normal = same(r.normal), a = same(r.a);
  const Double8 t = plain_dot(normal, a - eye) / plain_dot(normal, direction);
  const Vector8 p = sum(eye, scaled(t, direction)), from = p - a;
  const Double8 u = plain_dot(same(r.du), from), v = plain_dot(same(r.dv), from);
  const Double8 zero = splat<Double8>(0.0), one = splat<Double8>(1.0);
  const Truth<double, 8> inside = less(zero, t) &
                                  less(t, splat<Double8>(std::numeric_limits<double>::infinity())) &
                                  not_above(zero, u) & not_above(zero, v) & not_above(u + v, one);
  double px[8], py[8], pz[8];
  store(p.x, px), store(p.y, py), store(p.z, pz);
  for (int i = 0; i < 8; ++i) points[i] = {px[i], py[i], pz[i]};
  return bits(inside);
}

}  // namespace

VisibleRunKernels visible_run_kernels() {
  return {eight};
}

}  // namespace tenebra::points::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::points {

VisibleRunKernels visible_run_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, visible_run_kernels)();
}

}  // namespace tenebra::points
#endif
