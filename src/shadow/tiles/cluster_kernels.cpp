#include "shadow/tiles/cluster_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadow/tiles/cluster_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/pack_lanes-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

/// Corner k of all triangles.
SIMD_INLINE Pack3<Float16> corners_at(const glm::vec3* positions, const ClusterCorners& corners, int k) {
  const char* const from = reinterpret_cast<const char*>(&positions[corners.first]);
  const auto corner = [&](int i) HWY_ATTR {
    return load<Float4>(reinterpret_cast<const float*>(from + corners.offset[k][i]));
  };
  Float16 p[4];
  for (int i = 0; i < 4; ++i) p[i] = combine({corner(i), corner(i + 4), corner(i + 8), corner(i + 12)});
  return transposed(p);
}

void follow(const glm::vec3* positions, const ClusterCorners& corners, TriangleCluster& cluster,
            BoxNode& node, std::size_t lane) {
  float(*const axes[3])[16] = {cluster.x, cluster.y, cluster.z};
  const Float16 zero = broadcast<Float16>(0.0f);
  Float16 p[3][3], broken = zero;  // NaN where a coordinate is not finite
  for (int k = 0; k < 3; ++k) {
    const Pack3<Float16> corner = corners_at(positions, corners, k);
    p[0][k] = corner.x, p[1][k] = corner.y, p[2][k] = corner.z;
    for (int axis = 0; axis < 3; ++axis) broken = broken + p[axis][k] * zero;
  }
  const Mask<float, 16> used = mask_of_bits<float, 16>(corners.possible) & eq(broken, zero);
  cluster.used = bits(used);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Float16 top = broadcast<Float16>(infinity), bottom = broadcast<Float16>(-infinity);
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) store(select(used, p[axis][k], zero), axes[axis][k]);
    node.low[axis][lane] = reduce_min(select(used, min(p[axis][0], min(p[axis][1], p[axis][2])), top));
    node.high[axis][lane] = reduce_max(select(used, max(p[axis][0], max(p[axis][1], p[axis][2])), bottom));
  }
}

}  // namespace

ClusterKernels cluster_kernels() {
  return {follow};
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::shadow {

ClusterKernels cluster_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, cluster_kernels)();
}

}  // namespace tenebra::shadow
#endif
