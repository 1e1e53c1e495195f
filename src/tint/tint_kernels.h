// The inner loops of hard tints: eight boxes against a shaft, sixteen rays against a triangle.
#pragma once

#include <cstdint>

#include <tenebra/simd_level.h>
#include "shadow/decision/triangle_planes.h"
#include "tint/crossing.h"
#include "tint/shaft.h"

namespace tenebra::tint {

/// Boxes of eight triangles or of eight nodes; those left over hold nothing.
inline constexpr int box_lanes = 8;
struct alignas(64) EightBoxes {
  float rows[6][box_lanes];  ///< low x, y and z; high x, y and z
};

/// Code for one instruction set.
struct TintKernels {
  /// Bits of the boxes that may meet the shaft: conservative.
  std::uint32_t (*boxes_met)(const EightBoxes& boxes, const FloatShaft& shaft) = nullptr;
  /// Lanes whose rays cross for sure, and those that doubles leave open.
  LanesFound (*rays_crossing)(const shadow::TrianglePlanes& planes, const SampleTile& tile) = nullptr;
};
TintKernels tint_kernels(SimdLevel level);

}  // namespace tenebra::tint
