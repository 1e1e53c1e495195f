// The caster's entries, compiled once per instruction set.
#include "ao/triangle_bvh.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ao/bvh_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "ao/bvh_trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

CasterHit closest(const TriangleBvh& bvh, const CasterRay& ray) {
  return trace_ray<false>(bvh, ray);
}
bool any(const TriangleBvh& bvh, const CasterRay& ray) {
  return trace_ray<true>(bvh, ray).distance < no_distance;
}
void closest_batch(const TriangleBvh& bvh, const RayBatch& rays, float* distance) {
  for (int i = 0; i < batch_size; ++i) {
    const CasterHit hit = closest(bvh, {rays.origin(i), rays.direction(i), 0, distance[i], no_caster});
    if (hit.distance < distance[i]) distance[i] = hit.distance;
  }
}

}  // namespace

BvhKernels bvh_kernels() {
  return {closest, any, closest_batch};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra {

BvhKernels bvh_kernels(SimdLevel level) {
  switch (level == SimdLevel::automatic ? best_simd_level() : level) {
#if HWY_TARGETS & HWY_AVX3
    case SimdLevel::avx512:
      return N_AVX3::bvh_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdLevel::avx2:
      return N_AVX2::bvh_kernels();
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdLevel::sse4:
      return N_SSE4::bvh_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(bvh_kernels)();
  }
}

}  // namespace tenebra
#endif
