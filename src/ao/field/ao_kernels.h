// The vector code of ambient occlusion for one instruction set. Bits do not depend on which.
#pragma once

#include "ao/cast/ray_pattern.h"
#include "ao/field/field_lookup.h"
#include "trees/fan_caster.h"

namespace tenebra::ao {

struct AoKernels {
  FanKernels fan;                     ///< a point's rays, and what their hits add up to
  trees::ClosestFans cast = nullptr;  ///< rays of a point through triangles
  FieldKernels field;                 ///< rays through displacement fields
};
inline AoKernels ao_kernels(SimdLevel level) {
  return {fan_kernels(level), trees::closest_fans(level), field_kernels(level)};
}

}  // namespace tenebra::ao
