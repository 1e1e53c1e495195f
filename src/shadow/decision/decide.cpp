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

bool blocks_exactly(const OpenTriangle& t, const dvec3& point, std::uint32_t own, const RaySource& source,
                    const TriangleView& triangles, ContactRule contact) {
  const points::Corners& c = t.corners;
  for (int k = 0; k < 3; ++k) {
    if (((t.open >> k) & 1u) != 0 && !inside_edge(c, k, point, t.side, source)) return false;
  }
  if (((t.open >> 3) & 1u) == 0) return true;
  double threshold = 0;
  if (contact == ContactRule::triangle_ids) {
    const double tau_own = points::own_tolerance(triangles, own, point);
    threshold = points::contact_threshold(c.v, points::rounding_tolerance(c.v), tau_own);
  }
  return math::plane_excess(c.v[0], c.v[1], c.v[2], point, t.side, threshold) > 0;
}

bool decide(const TrianglePlanes& planes, const dvec3& point, std::uint32_t own, const RaySource& source,
            const TriangleView& triangles, ContactRule contact, TraceStats& stats) {
  const bool use_ids = contact == ContactRule::triangle_ids;
  if (use_ids && planes.triangle == own) return false;
  ++stats.float_unknown;
  const double tau_own = use_ids ? points::own_tolerance(triangles, own, point) : 0.0;
  const dvec3 p = point - source.origin;
  const double size = std::sqrt(glm::dot(p, p));
  std::uint32_t open = 0;
  for (int k = 0; k < 4; ++k) {
    const double slack = k == 3 ? tau_own : 0.0;
    const double value = planes.mx[k] * p.x + planes.my[k] * p.y + planes.mz[k] * p.z - planes.d[k] - slack;
    // rho: the plane's own error; 2^-50: rounding of p, of the four products and of tau.
    const double bound =
        planes.rho[k] * (size + planes.reach) + 0x1p-50 * (size + std::abs(planes.d[k]) + slack) + 0x1p-1000;
    if (value < -bound) return false;
    if (!(value > bound)) open |= 1u << k;
  }
  if (open == 0) return true;

  ++stats.double_unknown;
  return blocks_exactly({points::corners_of(triangles, planes.triangle), planes.side, open}, point, own,
                        source, triangles, contact);
}

}  // namespace tenebra::shadow
