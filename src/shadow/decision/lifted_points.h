// Points that were lifted off their triangles to a smooth surface: which of them may see a light that the
// triangle itself turns away from.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/visible_points.h>
#include "points/triangle_corners.h"
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

/// Which points of a triangle are active (hard_shadows.h).
enum class Faces : std::uint8_t {
  away = 0,    ///< none
  light = 1,   ///< all: the light is on their side
  beyond = 2,  ///< those that SeesPast says
};

/// Of points on `side` (or 0) of a triangle that the light is not on that side of: beyond, if the triangle is
/// smooth and the light is before the plane at one of its vertices; else away.
Faces faces_beyond(const TriangleView& triangles, std::uint32_t id, int side, const RaySource& source);

/// A triangle that the light is beyond, and which of its points see past it. Exact.
class SeesPast {
public:
  /// `side`: that its points are on.
  SeesPast(const TriangleView& triangles, std::uint32_t id, int side, const RaySource& source);
  /// Whether `point` is off the triangle's plane, on its side by more than the contact rule's
  /// threshold, and the way from there to the light does not meet the triangle (closed).
  bool from(const glm::dvec3& point) const;

private:
  const RaySource& source_;
  points::Corners corners_;
  double threshold_;
  int side_, light_side_;
};

}  // namespace tenebra::shadow
