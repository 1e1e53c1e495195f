// A point of a group in the axes of the light around the group's centre.
#pragma once

#include <tenebra/visible_points.h>
#include <cstdint>
#include <glm/glm.hpp>

#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

/// A point relative to the centre of its group and to the light.
struct GroupPoint {
  glm::dvec3 from_centre{0.0};  ///< world space
  glm::dvec3 in_axes{0.0};      ///< the same in the light's axes
  glm::dvec2 in_light{0.0};     ///< u and v from the light's origin
  double reach = 0;             ///< height of the light's plane over the point, units of the light
  double turn = 1;              ///< of the axes
  std::uint32_t receiver = no_triangle;
  double receiver_tau = 0;
};

inline GroupPoint group_point(const LightAxes& axes, const glm::dvec3& position, std::uint32_t receiver,
                              double receiver_tau) {
  GroupPoint at{position - axes.centre, {}, {}, 0, axes.turn, receiver, receiver_tau};
  at.in_axes = axes.of(at.from_centre);
  at.in_light = glm::dvec2(axes.centre_uv) + axes.weight * glm::dvec2(at.in_axes);
  at.reach = axes.centre_uv.z - axes.weight * at.in_axes.z;
  return at;
}

}  // namespace tenebra::soft
