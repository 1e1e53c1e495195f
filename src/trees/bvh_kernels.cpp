// The caster's entries, compiled once per instruction set.
#include "trees/triangle_bvh.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/bvh_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "trees/bvh_trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::trees::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

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

}  // namespace tenebra::trees::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::trees {

BvhKernels bvh_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, bvh_kernels)();
}

}  // namespace tenebra::trees
#endif
