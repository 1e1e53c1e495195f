// A second, deliberately dumb oracle: every triangle, every sample, nothing but rationals, another
// formulation (the point where the segment meets the plane, and its barycentric coordinates). It judges
// exact_mask.
#pragma once

#include <tenebra/hard_shadows.h>

namespace tenebra::reference {

ShadowMask rational_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                         const ShadowLight& light, const HardShadowConfig& config);

}  // namespace tenebra::reference
