// Points of neighbouring pixels that see one triangle, eight at a time: the operations of the scalar code in
// the same order, so the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/simd_level.h>
#include "points/receiver.h"

namespace tenebra::points {

/// Pixels of a row of a perspective view: directions d0 + ((x + 0.5) dx + row) from the eye.
struct PixelRow {
  glm::dvec3 eye, d0, dx, row;
};

/// Code for one instruction set.
struct VisibleRunKernels {
  /// Points of pixels x ... x + 7 on a receiver that is not flat. Returns the bits of those that lie inside
  /// the triangle; the others are left to be clamped.
  std::uint32_t (*eight)(const Receiver& receiver, const PixelRow& row, std::size_t x,
                         glm::dvec3 points[8]) = nullptr;
};
VisibleRunKernels visible_run_kernels(SimdLevel level);

}  // namespace tenebra::points
