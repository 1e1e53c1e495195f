#include "tint/tint_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tint/tint_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tenebra::tint::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

using Double8 = Pack<double, tile_samples / 2>;

// The bound is that of shadow::decide.
LanesFound crossing(const shadow::TrianglePlanes& planes, const SampleTile& tile) {
  LanesFound found;
  for (int first = 0; first < tile_samples; first += tile_samples / 2) {
    const Double8 x = load<Double8>(tile.x + first), y = load<Double8>(tile.y + first),
                  z = load<Double8>(tile.z + first), size = load<Double8>(tile.size + first);
    Double8 least = broadcast<Double8>(1.0), surest = least;
    for (int k = 0; k < 4; ++k) {
      const double rho = planes.rho[k], d = planes.d[k];
      Double8 value = broadcast<Double8>(planes.mx[k]) * x - broadcast<Double8>(d);
      value = mul_add(broadcast<Double8>(planes.my[k]), y, value);
      value = mul_add(broadcast<Double8>(planes.mz[k]), z, value);
      Double8 bound = mul_add(broadcast<Double8>(rho + 0x1p-50), size,
                              broadcast<Double8>(rho * planes.reach + 0x1p-50 * std::abs(d) + 0x1p-1000));
      if (k == 3) {
        const Double8 slack = load<Double8>(tile.tau + first);
        value = value - slack;
        bound = mul_add(broadcast<Double8>(0x1p-50), slack, bound);
      }
      least = min(least, value + bound);
      surest = min(surest, value - bound);
    }
    const Double8 zero = broadcast<Double8>(0.0);
    const std::uint32_t sure = lt_bits(zero, surest), missed = lt_bits(least, zero);
    found.sure |= sure << first;
    found.open |= (~(sure | missed) & 0xffu) << first;
  }
  return found;
}

}  // namespace

RaysCrossing rays_crossing() {
  return crossing;
}

}  // namespace tenebra::tint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::tint {

RaysCrossing rays_crossing(SimdLevel level) {
  return TENEBRA_DISPATCH(level, rays_crossing)();
}

}  // namespace tenebra::tint
#endif
