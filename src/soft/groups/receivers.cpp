#include "soft/groups/receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/l1_norm.h"
#include "points/contact_rule.h"
#include "points/smooth_surface.h"
#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The light sinks below the triangle's plane, or nearly so: finds whether points lifted off the triangle may
/// see some of what lies there.
void see_lifted(const TriangleView& triangles, const LightShape& light, LitTriangle& lit) {
  const points::SmoothSurface smooth =
      points::smooth_surface(triangles, lit.receiver.triangle, lit.receiver.side);
  if (!smooth.lifts) return;
  const points::Corners c = points::corners_of(triangles, lit.receiver.triangle);
  lit.receiver.lifted = lit.light_above;
  for (int k = 0; k < light.count; ++k) {
    for (int i = 0; i < 3; ++i) {
      const dvec3 from = light.origin + light.vertices[k] - light.weight * dvec3(c.v[i]);
      const double margin = 0x1p-46 * (math::l1_norm(from) + math::l1_norm(light.origin));
      lit.receiver.lifted |= glm::dot(smooth.normal[i], from) > -margin;
    }
  }
  lit.light_above |= lit.receiver.lifted;
}

}  // namespace

LitTriangle lit_triangle(const TriangleView& triangles, std::uint32_t id, int side, const LightShape& light) {
  const points::Corners c = points::corners_of(triangles, id);
  LitTriangle lit;
  lit.receiver.triangle = id;
  lit.receiver.side = side;
  lit.receiver.tau = points::rounding_tolerance(c.v);
  if (lit.receiver.side == 0) return lit;
  const dvec3 a(c.v[0]), e1 = dvec3(c.v[1]) - a, e2 = dvec3(c.v[2]) - a;
  const dvec3 n = glm::cross(e1, e2) * static_cast<double>(lit.receiver.side);
  const double length = std::sqrt(glm::dot(n, n));
  if (length > 0) lit.receiver.m = n / length;
  lit.level = glm::dot(lit.receiver.m, a - light.origin);
  lit.light_height = infinity;
  for (int k = 0; k < light.count; ++k) {
    const dvec3 q = light.origin + light.vertices[k], way = q - light.weight * a;
    // Q is off by 2^-50 of its coordinates, n and the dot product as in predicates.cpp.
    const double bound = 0x1p-46 * math::l1_norm(e1) * math::l1_norm(e2) *
                         (math::l1_norm(way) + math::l1_norm(light.origin) + math::l1_norm(q));
    lit.light_above |= glm::dot(n, way) > -bound;
    lit.light_height = std::min(lit.light_height, glm::dot(lit.receiver.m, light.vertices[k]));
  }
  if (!triangles.normals.empty()) {
    const double margin = 0x1p-40 * (light.reach + math::l1_norm(light.origin) + math::l1_norm(a));
    if (!(lit.light_height > light.weight * lit.level + margin)) see_lifted(triangles, light, lit);
  }
  return lit;
}

LitTriangle lit_free_points() {
  LitTriangle lit;
  lit.receiver.triangle = free_point;
  lit.light_above = true;
  lit.light_height = infinity;
  return lit;
}

// A line from P to Q meets T at X, more than tau_R away from P, as P lies more than that off T's plane. With
// h the height over the receiver's plane, h(X) >= h(P) + tau_R h(Q) / |PQ|: a triangle that stays below that
// blocks nothing (but for slivers thinner than 2^-47 of their length, whose n is rounding). Where the light
// sinks below the receiver's horizon only lines that rise count: h(X) >= h(P).
Receiver receiver_of(const LitTriangle& triangle, double lowest_point, const Cell& cell,
                     const LightShape& light) {
  Receiver receiver = triangle.receiver;
  if (receiver.m == dvec3(0) || receiver.lifted) {
    receiver.limit = -infinity;
    return receiver;
  }
  // tau / 2^-24 is sqrt(3) times the receiver's largest |coordinate|.
  const double margin =
      0x1p-46 * (cell.reach + light.place_reach() + largest(light.origin) + receiver.tau * 0x1p24);
  const double light_height = triangle.light_height - light.weight * triangle.level;
  const double distance = 1.7320508075688774 * (light.weight * cell.reach + light.reach) * (1 + 0x1p-40);
  double rise = 0;
  if (light_height > margin && distance > 0)
    rise = receiver.tau * (light_height - margin) / distance * (1 - 0x1p-40);
  receiver.limit = std::min(triangle.level, lowest_point) + rise - margin;
  return receiver;
}

ContactRange contact_range(std::span<const Receiver> receivers) {
  ContactRange range{infinity, 0};
  for (const Receiver& receiver : receivers)
    range.least = std::min(range.least, receiver.tau), range.most = std::max(range.most, receiver.tau);
  return range;
}

}  // namespace tenebra::soft
