// What all groups of a frame and light share, and what a group is before it is made ready.
#pragma once

#include <cstdint>
#include <span>

#include <tenebra/soft_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "soft/light/light_frame.h"
#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

/// What all groups of a frame and light share.
struct SoftFrame {
  const VisiblePoints& points;
  std::span<const glm::vec3> normals;  ///< of each pixel, or empty
  const TriangleView& triangles;
  const LightFrame& light;
  const SoftShadowConfig& config;
  SoftMask& out;
  std::span<std::uint8_t> classes;
  /// Whether a free point sees the half of space before it, and which way that is.
  bool sees_half(std::uint32_t pixel) const {
    return !points.sides.empty() && points.sides[pixel] != 0 && !normals.empty();
  }
  glm::dvec3 free_normal(std::uint32_t pixel) const {
    return sees_half(pixel) ? glm::dvec3(normals[pixel]) : -light.normal;
  }

  const StopFlag* stop;  ///< looked at for each point that needs a solver of its own; may be null
};

/// Points of one group, and what may stand between them and the light.
struct GroupTask {
  std::span<const std::uint32_t> pixels;
  GroupFrame frame;
  std::span<const std::uint32_t> candidates;  ///< triangles, ascending; all that block are among them
};

}  // namespace tenebra::soft
