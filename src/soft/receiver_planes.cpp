#include "soft/receiver_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

double largest(const dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Of the points of one receiver, relative to the light: how far below the plane m.p = level they reach at
// most, and their largest |coordinate|.
struct Extent {
  double depth = 0, reach = 0;
};
Extent extent_of(const PointGroups& groups, const PointGroup& group, std::uint32_t receiver, const dvec3& m,
                 double level, const dvec3& origin) {
  const auto points = groups.positions_of(group);
  const auto triangles = groups.triangles_of(group);
  Extent extent;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (triangles[i] != receiver) continue;
    const dvec3 p = points[i] - origin;
    extent.depth = std::max(extent.depth, level - glm::dot(m, p));
    extent.reach = std::max(extent.reach, largest(p));
  }
  return extent;
}

double lowest(const LightShape& light, const dvec3& m) {
  double low = infinity;
  for (int k = 0; k < light.count; ++k) low = std::min(low, glm::dot(m, light.vertices[k]));
  return low;
}

// A line from P to Q meets T at X, more than tau_R off P as T must be off P's side of its plane. With h the
// height over the receiver's plane, h(X) >= h(P) + tau_R h(Q) / |PQ|: a triangle that stays below that blocks
// nothing (but for slivers thinner than 2^-47 of their length, whose n is rounding). Where the light sinks
// below the receiver's horizon only lines that rise count: h(X) >= h(P).
ReceiverPlane plane_of(const PointGroups& groups, const PointGroup& group, const Receiver& receiver,
                       const TriangleView& triangles, const LightShape& light) {
  const Corners c = corners_of(triangles, receiver.triangle);
  const dvec3 a(c.v[0]), n = glm::cross(dvec3(c.v[1]) - a, dvec3(c.v[2]) - a);
  const double length = std::sqrt(glm::dot(n, n));
  if (!(length > 0)) return {receiver.triangle, dvec3(0), -infinity};
  const dvec3 m = n * (receiver.side / length);
  const double level = glm::dot(m, a - light.origin);
  const Extent points = extent_of(groups, group, receiver.triangle, m, level, light.origin);
  const double light_height = lowest(light, m) - level;

  const double tau = rounding_tolerance(c.v);  // over sqrt(3) 2^-24: the receiver's largest |coordinate|
  const double margin = 0x1p-46 * (points.reach + light.reach + largest(light.origin) + tau * 0x1p24);
  const double distance = 1.7320508075688774 * (points.reach + light.reach) * (1 + 0x1p-40);
  double rise = 0;
  if (light_height > margin && distance > 0) rise = tau * (light_height - margin) / distance * (1 - 0x1p-40);
  return {receiver.triangle, m, level - points.depth + rise - margin};
}

}  // namespace

void find_receiver_planes(const PointGroups& groups, const PointGroup& group, const TriangleView& triangles,
                          const LightShape& light, std::vector<ReceiverPlane>& out) {
  out.clear();
  for (const Receiver& receiver : groups.receivers_of(group))
    out.push_back(plane_of(groups, group, receiver, triangles, light));
}

ContactRange contact_range(const PointGroups& groups, const PointGroup& group,
                           const TriangleView& triangles) {
  ContactRange range{infinity, 0};
  for (const Receiver& receiver : groups.receivers_of(group)) {
    const double tau = rounding_tolerance(corners_of(triangles, receiver.triangle).v);
    range.least = std::min(range.least, tau), range.most = std::max(range.most, tau);
  }
  return range;
}

}  // namespace tenebra
