// Rays from one point through a tree of triangles, sixteen to a fan.
#pragma once

#include <span>

#include <tenebra/simd_level.h>
#include "trees/ray_batch.h"
#include "trees/triangle_bvh.h"

namespace tenebra::trees {

inline constexpr std::size_t fans_at_once = 4;

/// distance[i] = t of the nearest hit of ray i before distance[i] (finite); else left as it is. All rays
/// start at the first one's origin. facing[i], unless null: positive where the hit shows its front
/// (counter-clockwise), negative its back, 0 without a hit. Directions may have any length. What a ray finds
/// does not depend on the others, except where rounding puts a hit outside of the triangle's box: on
/// triangles seen edge-on, and on those smaller than a thousandth of the reach.
using ClosestFans = void (*)(const TriangleBvh& bvh, std::span<const RayBatch> rays, float* distance,
                             float* facing);

/// Code for one instruction set. Bits do not depend on it.
ClosestFans closest_fans(SimdLevel level);

}  // namespace tenebra::trees
