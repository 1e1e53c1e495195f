// The tests of shaft culling, on eight triangles at once, in double, or in float where its margins are
// negligible. Each drops a triangle only if it is certain that it blocks no line; margins are bounds on the
// rounding of the test.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/simd_level.h>
#include "soft/groups/receivers.h"
#include "soft/shafts/shaft.h"
#include "soft/shafts/triangle_blocks.h"

namespace tenebra::soft {

struct ShaftKernels {
  /// Triangles that may meet the shaft. Writes to `out` (room for all of `in`), returns how many references
  /// it wrote.
  std::size_t (*cull)(const Shaft& shaft, const TriangleBlock* blocks, std::span<const BlockRef> in,
                      BlockRef* out) = nullptr;
  /// Drops the triangles that, for each of the receivers, lie in its half-space or are the receiver itself
  /// (if it is not lifted).
  std::size_t (*drop_behind)(std::span<const Receiver> receivers, const LightShape& light,
                             const TriangleBlock* blocks, std::span<const BlockRef> in,
                             BlockRef* out) = nullptr;
  /// Drops triangles whose own plane does not have points and light on different sides, and, where blocks are
  /// few, those that all lines pass on the outer side of one edge (Theorem 1). `dark`, no_triangle before,
  /// gets the id of the first triangle that blocks all lines for certain, if there is one; it may be a
  /// receiver.
  std::size_t (*drop_beside)(const Shaft& shaft, ContactRange contact, const TriangleBlock* blocks,
                             std::span<const BlockRef> in, BlockRef* out, std::uint32_t& dark) = nullptr;
};
ShaftKernels shaft_kernels(SimdLevel level);

}  // namespace tenebra::soft
