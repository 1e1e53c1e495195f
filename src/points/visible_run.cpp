#include "points/visible_run.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "points/visible_run.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/double8-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

std::uint32_t eight(const Receiver& r, const PixelRow& row, std::size_t x, glm::dvec3 points[8]) {
  double places[8];
  for (std::size_t i = 0; i < 8; ++i) places[i] = static_cast<double>(x + i) + 0.5;
  const Vector8 across = load<Double8>(places) * broadcast8(row.dx) + broadcast8(row.row);
  const Vector8 direction = broadcast8(row.d0) + across;
  const Vector8 eye = broadcast8(row.eye), normal = broadcast8(r.normal), a = broadcast8(r.a);
  const Double8 t = dot_unfused(normal, a - eye) / dot_unfused(normal, direction);
  const Vector8 p = eye + t * direction, from = p - a;
  const Double8 u = dot_unfused(broadcast8(r.du), from), v = dot_unfused(broadcast8(r.dv), from);
  const Double8 zero = broadcast<Double8>(0.0), one = broadcast<Double8>(1.0);
  const Mask<double, 8> inside = lt(zero, t) &
                                 lt(t, broadcast<Double8>(std::numeric_limits<double>::infinity())) &
                                 le(zero, u) & le(zero, v) & le(u + v, one);
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
