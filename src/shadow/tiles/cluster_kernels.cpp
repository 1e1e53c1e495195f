#include "shadow/tiles/cluster_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/cluster_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/pack-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

namespace {

void follow(const glm::vec3* positions, const ClusterCorners& corners, TriangleCluster& cluster,
            BoxNode& node, std::size_t lane) {
  float(*const axes[3])[16] = {cluster.x, cluster.y, cluster.z};
  const float* const from = &positions[corners.first].x;
  const Float16 zero = splat<Float16>(0.0f);
  Float16 p[3][3], broken = zero;  // NaN where a coordinate is not finite
  for (int k = 0; k < 3; ++k) {
    const Int16 offset = load<Int16>(corners.offset[k]);
    for (int axis = 0; axis < 3; ++axis) {
      p[axis][k] = gather<float>(from + axis, offset);
      broken = broken + p[axis][k] * zero;
    }
  }
  const Truth<float, 16> used = truth_of<float, 16>(corners.possible) & equal(broken, zero);
  cluster.used = bits(used);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Float16 top = splat<Float16>(infinity), bottom = splat<Float16>(-infinity);
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) store(choose(used, p[axis][k], zero), axes[axis][k]);
    node.low[axis][lane] = least(choose(used, min(p[axis][0], min(p[axis][1], p[axis][2])), top));
    node.high[axis][lane] = greatest(choose(used, max(p[axis][0], max(p[axis][1], p[axis][2])), bottom));
  }
}

}  // namespace

ClusterKernels cluster_kernels() {
  return {follow};
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra {

ClusterKernels cluster_kernels(SimdLevel level) {
  switch (level == SimdLevel::automatic ? best_simd_level() : level) {
#if HWY_TARGETS & HWY_AVX3
    case SimdLevel::avx512:
      return N_AVX3::cluster_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdLevel::avx2:
      return N_AVX2::cluster_kernels();
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdLevel::sse4:
      return N_SSE4::cluster_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(cluster_kernels)();
  }
}

}  // namespace tenebra
#endif
