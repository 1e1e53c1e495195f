#include "shadow/decision/lifted_points.h"

#include "math/predicates.h"
#include "points/contact_rule.h"
#include "points/smooth_surface.h"
#include "points/triangle_corners.h"

namespace tenebra::shadow {

Faces faces_beyond(const TriangleView& triangles, std::uint32_t id, int side, const RaySource& source) {
  return points::is_before(triangles, id, side, {source.directional, source.light}) ? Faces::beyond
                                                                                    : Faces::away;
}

SeesPast::SeesPast(const TriangleView& triangles, std::uint32_t id, int side, const RaySource& source)
    : source_(source),
      corners_(points::corners_of(triangles, id)),
      side_(side),
      light_side_(light_side(corners_.v, source)) {
  const double tau = points::rounding_tolerance(corners_.v);
  threshold_ = points::contact_threshold(corners_.v, tau, tau);
}

bool SeesPast::from(const glm::dvec3& point) const {
  const glm::vec3(&v)[3] = corners_.v;
  if (math::plane_excess(v[0], v[1], v[2], point, side_, threshold_) <= 0) return false;
  if (light_side_ == 0) return true;
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 &a = v[k], &b = v[(k + 1) % 3];
    const int edge = source_.directional ? math::edge_side_infinite(source_.light, a, b, point)
                                         : math::edge_side(source_.light, a, b, point);
    if (light_side_ * edge < 0) return true;
  }
  return false;
}

}  // namespace tenebra::shadow
