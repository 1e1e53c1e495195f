#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/cast/ray_fan.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/cast/ray_pattern.h"
#include "simd/dispatch.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::ao::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

// Products and sums apart, never fused: the bits are the same on all targets.
SIMD_INLINE Float16 component(const Pack3<Float16>& d, float x, float y, float z) {
  return d.x * broadcast<Float16>(x) + d.y * broadcast<Float16>(y) + d.z * broadcast<Float16>(z);
}

void spread(const RayPattern& pattern, const RayAxes& axes, const glm::vec3& face, const glm::vec3& origin,
            trees::RayBatch* out) {
  const Float16 zero = broadcast<Float16>(0.0f), two = broadcast<Float16>(2.0f);
  const Float16 ox = broadcast<Float16>(origin.x), oy = broadcast<Float16>(origin.y),
                oz = broadcast<Float16>(origin.z);
  for (const RayPattern::Batch& batch : pattern.batches) {
    const Pack3<Float16> local{load<Float16>(batch.x), load<Float16>(batch.y), load<Float16>(batch.z)};
    const Pack3<Float16> d{component(local, axes.x.x, axes.y.x, axes.z.x),
                           component(local, axes.x.y, axes.y.y, axes.z.y),
                           component(local, axes.x.z, axes.y.z, axes.z.z)};
    const Float16 below = two * min(component(d, face.x, face.y, face.z), zero);
    const Pack3<Float16> mirrored = subtract_scaled(
        d, below, {broadcast<Float16>(face.x), broadcast<Float16>(face.y), broadcast<Float16>(face.z)});
    store(ox, out->ox), store(oy, out->oy), store(oz, out->oz);
    store(mirrored.x, out->dx), store(mirrored.y, out->dy), store(mirrored.z, out->dz);
    ++out;
  }
}

float fall_off(const float* distances, int batches, float reach) {
  const Float16 one = broadcast<Float16>(1.0f), zero = broadcast<Float16>(0.0f),
                inverse = broadcast<Float16>(1 / reach);
  Float16 sum = zero;
  for (int b = 0; b < batches; ++b)
    sum = sum + max(zero, one - load<Float16>(distances + b * trees::batch_size) * inverse);
  float lanes[trees::batch_size];
  store(sum, lanes);
  float total = 0;
  for (const float lane : lanes) total += lane;
  return total;
}

}  // namespace

FanKernels fan_kernels() {
  return {spread, fall_off};
}

}  // namespace tenebra::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::ao {

FanKernels fan_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, fan_kernels)();
}

}  // namespace tenebra::ao
#endif
