// Sort keys of rays: by direction, along a curve over the faces of a cube.
#pragma once

#include <tenebra/simd_level.h>
#include <cstdint>

namespace tenebra::shadow {

/// Keys of sixteen directions of any length: cube face 0..5 by the major axis and its sign in bits 28 to 30,
/// below it the Hilbert index of the other two coordinates over the face, 14 bits each.
using DirectionKeys = void (*)(const float* x, const float* y, const float* z, std::uint32_t* keys);
DirectionKeys direction_keys_kernel(SimdLevel level);

}  // namespace tenebra::shadow
