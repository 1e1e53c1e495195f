// Triangles of a group against its points and the light: planes, edges as lines on the light's plane, and the
// sides on which all points or all of the light lie. Sides are conservative: margins cover the rounding of
// double. Internal to src/soft.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "points/visible_points.h"
#include "soft/group_occluders.h"
#include "soft/light_frame.h"

namespace tenebra {

/// Rounding of the sums of products here, relative to the sum of their magnitudes: fewer than 16 operations
/// on inputs that carry one rounding each.
inline constexpr double rounding = 0x1p-48;

struct Triangle3 {
  glm::dvec3 v[3];
  glm::dvec3 normal;  ///< not unit
  double tau = 0;     ///< rounding_tolerance
};
Triangle3 triangle_in_double(const TriangleView& triangles, std::uint32_t id);

inline double sum_of(const glm::dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// {n.ex, n.ey, n.to_origin}: the line where a plane of normal n meets that of the light; `to_origin` goes
/// from the plane to the light's origin.
glm::dvec3 trace_of(const LightFrame& light, const glm::dvec3& n, const glm::dvec3& to_origin);

/// The line of the edge from a to b, times `sign`; `centre` of the group.
MovingLine edge_line(const LightFrame& light, const glm::dvec3& centre, const glm::dvec3& a,
                     const glm::dvec3& b, double sign);

/// Largest sum of coefficients over the group's box, at most.
double size_of(const MovingLine& line, const glm::dvec3& half);

enum class Side { negative, mixed, positive };

/// Which side all of the light lies on for all points of the group. Theorem 1 of Mora et al. 2012: the values
/// at the light's vertices and the box's corners decide (each value is affine in the point).
Side side_of(const MovingLine& line, const LightFrame& light, const glm::dvec3& half);

/// On which sides of an occluder's plane the group and the light lie.
struct PlaneSides {
  int points =
      0;  ///< +1, -1: all points lie beyond the contact threshold on this side of the normal; 0: not all
  Side light = Side::mixed;
  bool never = false;  ///< no point lies beyond the threshold on any side
};
PlaneSides plane_sides(const Triangle3& t, const LightFrame& light, const GroupFrame& group);

/// The plane of a triangle as the contact rule needs it at each point.
PlaneHeight plane_height(const Triangle3& t, const GroupFrame& group);

/// Occluder::size: the solid angle of the triangle at a point, as its binary logarithm, rounded down.
int size_class(const Triangle3& t, const glm::dvec3& point);

inline bool contains(std::span<const std::uint32_t> list, std::uint32_t id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

}  // namespace tenebra
