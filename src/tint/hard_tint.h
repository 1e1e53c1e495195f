// Lights without an area: the see-through triangles between each sample and the light, multiplied.
#pragma once

#include <span>
#include <vector>

#include <tenebra/tint.h>
#include "parallel/made_once.h"
#include "points/point_tiles.h"
#include "shadow/decision/triangle_planes.h"
#include "tint/crossing.h"
#include "tint/pane_tree.h"
#include "tint/panes.h"

namespace tenebra::tint {

/// Planes of see-through triangles as one light sees them, made when they are first asked for.
class LazyPlanes {
public:
  void reset(std::span<const std::uint32_t> ids);
  /// Of the triangle with this place in `ids`; side 0: crossed by none. May be in `room`. From any thread.
  const shadow::TrianglePlanes& of(std::uint32_t number, const CrossingFrame& frame,
                                   shadow::TrianglePlanes& room);

private:
  std::span<const std::uint32_t> ids_;
  std::vector<shadow::TrianglePlanes> planes_;
  parallel::MadeOnce made_;
};

/// Buffers kept from frame to frame.
class HardTint {
public:
  /// TintTracer::trace for a light without an area. `tiles` are of `points`.
  bool trace(const VisiblePoints& points, const points::PointTiles& tiles, const TriangleView& triangles,
             const Panes& panes, const PaneTree& tree, const ShadowLight& light, const ShadowMask& mask,
             const TintConfig& config, TintMask& out, TintStats& stats, const StopFlag* stop);

private:
  LazyPlanes planes_;
};

}  // namespace tenebra::tint
