// Positions of visible points for code that reads all of them.
#pragma once

#include <tenebra/visible_points.h>
#include "points/receiver.h"
#include "points/sample_sides.h"
#include "points/smooth_surface.h"

namespace tenebra::points {

/// `points`, or `scratch` with the same points (and no tiles) if `points` has no positions.
const VisiblePoints& with_positions(const VisiblePoints& points, const TriangleView& triangles,
                                    VisiblePoints& scratch);

/// Positions of pixels one by one, quick where neighbours lie on one triangle. One for each thread.
class PositionFinder {
public:
  PositionFinder(const VisiblePoints& points, const TriangleView& triangles)
      : points_(points),
        triangles_(triangles),
        rays_(ViewOfSamples::or_any(points.seen_from)),
        sides_(points, triangles) {}
  /// As visible_position().
  glm::dvec3 at(std::size_t pixel);

private:
  const VisiblePoints& points_;
  const TriangleView& triangles_;
  const PixelRays rays_;
  SideFinder sides_;
  Receiver receiver_;
  SmoothSurface smooth_;
};

}  // namespace tenebra::points
