// The vector code of rays from points for one instruction set. Bits do not depend on which.
#pragma once

#include "ao/cast/ray_pattern.h"
#include "trees/fan_caster.h"

namespace tenebra::ao {

struct RayKernels {
  FanKernels fan;                     ///< a point's rays, and what their hits add up to
  trees::ClosestFans cast = nullptr;  ///< rays of a point through triangles
};
inline RayKernels ray_kernels(SimdLevel level) {
  return {fan_kernels(level), trees::closest_fans(level)};
}

}  // namespace tenebra::ao
