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
  light = 1,   ///< all: light and eye are on one side
  beyond = 2,  ///< those that SeesPast says
};

/// Of a triangle that light and eye are on different sides of, or that is edge-on to the light: beyond, if it
/// is smooth and the light is before the plane at one of its vertices; else away.
/// `side`: the eye's, or 0.
Faces faces_beyond(const TriangleView& triangles, std::uint32_t id, int side, const RaySource& source);

/// A triangle that the light is beyond, and which of its points see past it. Exact.
class SeesPast {
public:
  SeesPast(const TriangleView& triangles, std::uint32_t id, const ViewRays& view, const RaySource& source);
  /// Whether `point` is off the triangle's plane, on the eye's side by more than the contact rule's
  /// threshold, and the way from there to the light does not meet the triangle (closed).
  bool from(const glm::dvec3& point) const;

private:
  const RaySource& source_;
  points::Corners corners_;
  double threshold_;
  int eye_side_, light_side_;
};

}  // namespace tenebra::shadow
