// The triangles on which a group's points lie, and how they limit its occluders: nothing behind a receiver
// blocks, nor does the receiver itself; and the contact rule's tolerances.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/visible_points.h>
#include "soft/groups/cell.h"

namespace tenebra::soft {

/// A triangle on which points of a group lie (or free_point), the side of it that they are on (1: in front,
/// counter- clockwise; -1: behind), and the half-space of it that no line from its points in the group to the
/// light enters: a triangle with m.(v - light's centre) <= limit for its vertices blocks none of them. No
/// such half-space if it is lifted, and then it may block them itself.
struct Receiver {
  std::uint32_t triangle = no_triangle;
  std::int32_t side = 0;
  bool lifted = false;  ///< it is smooth and the light sinks below its plane: points off it may see past it
  double tau = 0;       ///< rounding tolerance (contact_rule.h)
  glm::dvec3 m{0.0};    ///< unit
  double limit = 0;
};

/// How a triangle lies relative to a light, for points on one side of it.
struct LitTriangle {
  Receiver receiver;         ///< but for the limit
  bool light_above = false;  ///< a part of the light may be on that side of the plane or, lifted, of one
                             ///< across a vertex's normal
  double level = 0;          ///< m.(v - light's centre) of the plane
  double light_height = 0;   ///< m.(v - light's centre) of the light's lowest vertex; for a sun m.v
};
LitTriangle lit_triangle(const TriangleView& triangles, std::uint32_t id, int side, const LightShape& light);

/// Of free points, which any part of the light may reach; their tolerances are not set.
LitTriangle lit_free_points();

/// The receiver of points of a cell whose least m.(p - light's centre) is `lowest_point`.
Receiver receiver_of(const LitTriangle& triangle, double lowest_point, const Cell& cell,
                     const LightShape& light);

/// Contact tolerances (tau_R) of the receivers of a group.
struct ContactRange {
  double least = 0, most = 0;
};
ContactRange contact_range(std::span<const Receiver> receivers);

}  // namespace tenebra::soft
