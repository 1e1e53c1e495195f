// The last word on a ray and a triangle that the float filter left open: double with a bound, then exact
// signs.
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "points/triangle_corners.h"
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

/// Whether `planes.triangle` blocks the sample at `point` on triangle `own`: the contract of
/// trace_shadow_mask, exact. Counts into stats.float_unknown and stats.double_unknown.
bool decide(const TrianglePlanes& planes, const glm::dvec3& point, std::uint32_t own, const RaySource& source,
            const TriangleView& triangles, ContactRule contact, TraceStats& stats);

/// Planes of a triangle, by bits: its edges AB, BC, CA and its own.
inline constexpr std::uint32_t all_planes = 15;

/// A triangle on side `side` (not 0) of the light, and the planes that are still to be asked.
struct OpenTriangle {
  points::Corners corners;
  int side;
  std::uint32_t open;
};
/// The last stage of decide(): whether the sample is inside of all planes that are open. Not of the sample's
/// own triangle under the contact rule.
bool blocks_exactly(const OpenTriangle& triangle, const glm::dvec3& point, std::uint32_t own,
                    const RaySource& source, const TriangleView& triangles, ContactRule contact);

}  // namespace tenebra::shadow
