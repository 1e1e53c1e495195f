// The last word on a ray and a triangle that the float filter left open: double with a bound, then exact
// signs.
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

/// Whether `planes.triangle` blocks the sample at `point` on triangle `own`: the contract of
/// trace_shadow_mask, exact. Counts into stats.float_unknown and stats.double_unknown.
bool decide(const TrianglePlanes& planes, const glm::dvec3& point, std::uint32_t own, const RaySource& source,
            const TriangleView& triangles, ContactRule contact, TraceStats& stats);

}  // namespace tenebra::shadow
