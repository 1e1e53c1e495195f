// Where the points of a group, or of several, lie, and on which triangles.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "soft/groups/point_groups.h"

namespace tenebra::soft {

/// What the points of a group share. World space.
struct GroupFrame {
  glm::dvec3 centre{0.0}, half{0.0};         ///< box of the points
  std::span<const std::uint32_t> receivers;  ///< triangles that the points lie on, ascending
  double receiver_tau = 0;                   ///< largest rounding tolerance of these
};

/// The frame of one group or of several together; their triangles go to `receivers`, which it refers to.
GroupFrame frame_of(std::span<const PointGroup* const> of, const PointGroups& groups,
                    std::vector<std::uint32_t>& receivers);

}  // namespace tenebra::soft
