// Sixteen rays from one point through a tree of triangles at once.
#pragma once

#include <tenebra/simd_level.h>
#include "ao/cast/ray_batch.h"
#include "ao/cast/triangle_bvh.h"

namespace tenebra::ao {

/// distance[i] = t of the nearest hit of ray i before distance[i] (finite); else left as it is. All rays
/// start at the first one's origin. facing[i], unless null: positive where the hit shows its front
/// (counter-clockwise), negative its back, 0 without a hit.
using ClosestFan = void (*)(const TriangleBvh& bvh, const RayBatch& rays, float* distance, float* facing);

/// Code for one instruction set. Bits do not depend on it.
ClosestFan closest_fan(SimdLevel level);

}  // namespace tenebra::ao
