// Lights without an area: the see-through triangles between each sample and the light, multiplied.
#pragma once

#include <vector>

#include <tenebra/tint.h>
#include "points/point_tiles.h"
#include "shadow/decision/triangle_planes.h"
#include "tint/crossing.h"
#include "tint/surfaces.h"
#include "tint/triangle_tree.h"

namespace tenebra::tint {

/// Buffers kept from frame to frame.
class HardTint {
public:
  /// TintTracer::trace for a light without an area. `tiles` are of `points`.
  void trace(const VisiblePoints& points, const points::PointTiles& tiles, const TriangleView& triangles,
             const Surfaces& surfaces, const TriangleTree& tree, const ShadowLight& light,
             const ShadowMask& mask, ContactRule contact, TintMask& out, TintStats& stats);

private:
  std::vector<shadow::TrianglePlanes>
      planes_;  ///< one for each see-through triangle; side 0: crossed by none
};

}  // namespace tenebra::tint
