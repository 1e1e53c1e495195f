// What the triangles on which a group's points lie say about its occluders: what lies behind them blocks
// nothing, nor do they themselves; and the contact rule's tolerances.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "soft/point_groups.h"
#include "soft/shaft.h"

namespace tenebra {

/// Half-space of a receiver that no line from its points in the group to the light enters: a triangle with
/// m.(v - origin) <= limit for its vertices blocks none of them, nor does the receiver itself.
struct ReceiverPlane {
  std::uint32_t triangle = no_triangle;
  glm::dvec3 m{0.0};  ///< unit
  double limit = 0;
};

/// Contact tolerances (tau_R) of the receivers of a group.
struct ContactRange {
  double least = 0, most = 0;
};

/// One a receiver of the group with these points and this shaft.
void find_receiver_planes(std::span<const Receiver> receivers, const PointLanes& points, const Shaft& shaft,
                          const ShaftMaker& maker, const TriangleView& triangles,
                          std::vector<ReceiverPlane>& out);

ContactRange contact_range(std::span<const Receiver> receivers, const TriangleView& triangles);

}  // namespace tenebra
