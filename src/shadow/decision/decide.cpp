#include "shadow/decision/decide.h"

#include <cmath>

#include "math/predicates.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;
using glm::vec3;

bool inside_edge(const points::Corners& c, int k, const dvec3& point, int side, const RaySource& source) {
  const vec3 &a = c.v[k], &b = c.v[(k + 1) % 3];
  const int sign = source.directional ? math::edge_side_infinite(source.light, a, b, point)
                                      : math::edge_side(source.light, a, b, point);
  return side * sign >= 0;
}

}  // namespace

bool decide(const TrianglePlanes& planes, const dvec3& point, std::uint32_t own, const RaySource& source,
            const TriangleView& triangles, ContactRule contact, TraceStats& stats) {
  const bool use_ids = contact == ContactRule::triangle_ids;
  if (use_ids && planes.triangle == own) return false;
  ++stats.float_unknown;
  const double tau_own = use_ids ? points::rounding_tolerance(points::corners_of(triangles, own).v) : 0.0;
  const dvec3 p = point - source.origin;
  const double size = std::sqrt(glm::dot(p, p));
  bool open[4];
  bool any_open = false;
  for (int k = 0; k < 4; ++k) {
    const double slack = k == 3 ? tau_own : 0.0;
    const double value = planes.mx[k] * p.x + planes.my[k] * p.y + planes.mz[k] * p.z - planes.d[k] - slack;
    // rho: the plane's own error; 2^-50: rounding of p, of the four products and of tau.
    const double bound =
        planes.rho[k] * (size + planes.reach) + 0x1p-50 * (size + std::abs(planes.d[k]) + slack) + 0x1p-1000;
    if (value < -bound) return false;
    open[k] = !(value > bound);
    any_open |= open[k];
  }
  if (!any_open) return true;

  ++stats.double_unknown;
  const points::Corners c = points::corners_of(triangles, planes.triangle);
  for (int k = 0; k < 3; ++k) {
    if (open[k] && !inside_edge(c, k, point, planes.side, source)) return false;
  }
  if (!open[3]) return true;
  const double threshold =
      use_ids ? points::contact_threshold(c.v, points::rounding_tolerance(c.v), tau_own) : 0.0;
  return math::plane_excess(c.v[0], c.v[1], c.v[2], point, planes.side, threshold) > 0;
}

}  // namespace tenebra::shadow
