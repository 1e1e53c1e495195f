// Positions of visible points for those who read all of them.
#pragma once

#include <tenebra/visible_points.h>

namespace tenebra::points {

/// `points`, or `scratch` with the same points (and no tiles) if `points` has no positions.
const VisiblePoints& with_positions(const VisiblePoints& points, const TriangleView& triangles,
                                    VisiblePoints& scratch);

}  // namespace tenebra::points
