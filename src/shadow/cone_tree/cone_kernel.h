// The cone around the sixteen rays of a leaf, sixteen at a time.
#pragma once

#include <tenebra/simd_level.h>

#include "shadow/cone_tree/cone_tree.h"

namespace tenebra::shadow {

/// Bounds all sixteen rays of a packet (point lights, reach within 1e-15..1e15); conservative.
using ConeAround = ConeNode (*)(const RayPacket& packet);
ConeAround cone_around_kernel(SimdLevel level);

}  // namespace tenebra::shadow
