// The tests of shaft culling, on eight triangles at once, in double. Each drops a triangle only if it is
// certain that it blocks no line; margins are bounds on the rounding of the test.
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
  /// Drops what lies in the half-spaces of all receivers.
  std::size_t (*drop_behind)(std::span<const Receiver> receivers, const LightShape& light,
                             const TriangleBlock* blocks, std::span<const BlockRef> in,
                             BlockRef* out) = nullptr;
  /// Drops triangles whose own plane has not points and light on two sides and, where they are few, what all
  /// lines pass on the outer side of an edge (Theorem 1). `dark` gets the id of the first triangle that
  /// blocks all lines for certain, if there is one; it may be a receiver.
  std::size_t (*drop_beside)(const Shaft& shaft, ContactRange contact, const TriangleBlock* blocks,
                             std::span<const BlockRef> in, BlockRef* out, std::uint32_t& dark) = nullptr;
};
ShaftKernels shaft_kernels(SimdLevel level);

}  // namespace tenebra::soft
