// What is done to sixteen rays at once before any triangle is met: sorting keys and the cones of leaves.
#pragma once

#include <cstdint>

#include <tenebra/hard_config.h>
#include "shadow/cone_tree/cone_tree.h"

namespace tenebra::shadow {

/// Code for one instruction set.
struct RayKernels {
  /// Keys of sixteen directions of any length: cube face 0..5 by the major axis and its sign in bits 28 to
  /// 30, below it the Hilbert index of the other two coordinates over the face, 14 bits each.
  void (*direction_keys)(const float* x, const float* y, const float* z, std::uint32_t* keys) = nullptr;
  /// Bounds all sixteen rays of a packet (point lights, reach within 1e-15..1e15); conservative.
  ConeNode (*cone_around)(const RayPacket& packet) = nullptr;
};
RayKernels ray_kernels(SimdLevel level);

}  // namespace tenebra::shadow
