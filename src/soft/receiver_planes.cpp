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

double lowest(const LightShape& light, const dvec3& m) {
  double low = infinity;
  for (int k = 0; k < light.count; ++k) low = std::min(low, glm::dot(m, light.vertices[k]));
  return low;
}

// A line from P to Q meets T at X, more than tau_R off P as T must be off P's side of its plane. With h the
// height over the receiver's plane, h(X) >= h(P) + tau_R h(Q) / |PQ|: a triangle that stays below that blocks
// nothing (but for slivers thinner than 2^-47 of their length, whose n is rounding). Where the light sinks
// below the receiver's horizon only lines that rise count: h(X) >= h(P).
ReceiverPlane plane_of(const PointLanes& points, const Shaft& shaft, const ShaftMaker& maker,
                       const Receiver& receiver, const TriangleView& triangles) {
  const LightShape& light = *shaft.light;
  const Corners c = corners_of(triangles, receiver.triangle);
  const dvec3 a(c.v[0]), n = glm::cross(dvec3(c.v[1]) - a, dvec3(c.v[2]) - a);
  const double length = std::sqrt(glm::dot(n, n));
  if (!(length > 0)) return {receiver.triangle, dvec3(0), -infinity};
  const dvec3 m = n * (receiver.side / length);
  const double level = glm::dot(m, a - light.origin);
  const double lowest_point = std::min(level, maker.lowest_point(points, receiver.triangle, m));
  const double light_height = lowest(light, m) - level;

  const double tau = rounding_tolerance(c.v);  // over sqrt(3) 2^-24: the receiver's largest |coordinate|
  const double margin = 0x1p-46 * (shaft.cell.reach + light.reach + largest(light.origin) + tau * 0x1p24);
  const double distance = 1.7320508075688774 * (shaft.cell.reach + light.reach) * (1 + 0x1p-40);
  double rise = 0;
  if (light_height > margin && distance > 0) rise = tau * (light_height - margin) / distance * (1 - 0x1p-40);
  return {receiver.triangle, m, lowest_point + rise - margin};
}

}  // namespace

void find_receiver_planes(std::span<const Receiver> receivers, const PointLanes& points, const Shaft& shaft,
                          const ShaftMaker& maker, const TriangleView& triangles,
                          std::vector<ReceiverPlane>& out) {
  out.clear();
  for (const Receiver& receiver : receivers)
    out.push_back(plane_of(points, shaft, maker, receiver, triangles));
}

ContactRange contact_range(std::span<const Receiver> receivers, const TriangleView& triangles) {
  ContactRange range{infinity, 0};
  for (const Receiver& receiver : receivers) {
    const double tau = rounding_tolerance(corners_of(triangles, receiver.triangle).v);
    range.least = std::min(range.least, tau), range.most = std::max(range.most, tau);
  }
  return range;
}

}  // namespace tenebra
