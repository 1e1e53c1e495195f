// The inner loop of hard tints: sixteen rays against a triangle.
#pragma once

#include <cstdint>

#include <tenebra/simd_level.h>
#include "shadow/decision/triangle_planes.h"
#include "tint/crossing.h"

namespace tenebra::tint {

/// Lanes whose rays cross for sure, and those that doubles leave open.
using RaysCrossing = LanesFound (*)(const shadow::TrianglePlanes& planes, const SampleTile& tile);
/// Code for one instruction set.
RaysCrossing rays_crossing(SimdLevel level);

}  // namespace tenebra::tint
