// The vector code of ambient occlusion for one instruction set. Bits do not depend on which.
#pragma once

#include "ao/field_lookup.h"
#include "ao/ray_pattern.h"
#include "ao/triangle_bvh.h"

namespace tenebra {

struct AoKernels {
  FanKernels fan;      ///< a point's rays, and what their hits add up to
  BvhKernels bvh;      ///< rays through triangles
  FieldKernels field;  ///< rays through displacement fields
};
inline AoKernels ao_kernels(SimdLevel level) {
  return {fan_kernels(level), bvh_kernels(level), field_kernels(level)};
}

}  // namespace tenebra
