// What each pixel sees, found by the plainest means: one triangle after another, one pixel after another, in
// double. Sums, products, quotients and roots only, so that the ids are the same on every machine, with any
// graphics driver and any ray caster.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::bench {

/// Id of the nearest triangle beyond the near plane that the ray through each pixel's centre meets, the lower
/// one of equally near ones; no_triangle: none. Row 0 at the top.
std::vector<std::uint32_t> plainly_seen_triangles(const TriangleView& triangles, const ViewRays& view,
                                                  int width, int height);

}  // namespace tenebra::bench
