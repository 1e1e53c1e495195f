#include "tint/crossing.h"

#include <bit>
#include <cmath>

#include "math/predicates.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra::tint {
namespace {

using glm::dvec3;
using glm::vec3;

int edge_sign(const shadow::RaySource& source, const vec3& a, const vec3& b, const dvec3& point) {
  return source.directional ? math::edge_side_infinite(source.light, a, b, point)
                            : math::edge_side(source.light, a, b, point);
}

/// A number that the sum with `x`, and that sum's difference from x, is exact for.
double exact_step(float x) {
  return x != 0 ? std::ldexp(1.0, std::ilogb(x)) : 1.0;
}

/// The sign of an edge for a point in its plane through the light, moved by (e, e^2, e^3): the first
/// coordinate of the plane's normal that is not 0. The normal changes its sign with the edge's direction.
int moved_sign(const shadow::RaySource& source, const vec3& a, const vec3& b) {
  const vec3& from = source.directional ? a : source.light;  // in the plane
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 beside(from);
    beside[axis] += exact_step(from[axis]);
    if (const int sign = edge_sign(source, a, b, beside); sign != 0) return sign;
  }
  return 0;
}

bool inside_edge(const shadow::RaySource& source, const points::Corners& c, int k, const dvec3& point,
                 int side) {
  const vec3 &a = c.v[k], &b = c.v[(k + 1) % 3];
  const int sign = edge_sign(source, a, b, point);
  return side * (sign != 0 ? sign : moved_sign(source, a, b)) > 0;
}

}  // namespace

bool crosses(const CrossingFrame& frame, const shadow::TrianglePlanes& planes, const dvec3& point,
             std::uint32_t own) {
  const bool use_ids = frame.contact == ContactRule::triangle_ids;
  if (use_ids && planes.triangle == own) return false;
  const points::Corners c = points::corners_of(frame.triangles, planes.triangle);
  for (int k = 0; k < 3; ++k)
    if (!inside_edge(frame.source, c, k, point, planes.side)) return false;
  const double threshold = use_ids
                               ? points::contact_threshold(c.v, points::rounding_tolerance(c.v),
                                                           points::own_tolerance(frame.triangles, own, point))
                               : 0.0;
  return math::plane_excess(c.v[0], c.v[1], c.v[2], point, planes.side, threshold) > 0;
}

std::uint32_t lanes_crossing(const CrossingFrame& frame, const shadow::TrianglePlanes& planes,
                             const SampleTile& tile, const LanesFound& found, std::uint64_t& exact) {
  std::uint32_t sure = found.sure;
  if (frame.contact == ContactRule::triangle_ids) {
    for (std::uint32_t left = sure; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (tile.own[i] == planes.triangle) sure &= ~(1u << i);
    }
  }
  for (std::uint32_t open = found.open; open != 0; open &= open - 1) {
    const int i = std::countr_zero(open);
    ++exact;
    if (crosses(frame, planes, tile.points[i], tile.own[i])) sure |= 1u << i;
  }
  return sure;
}

}  // namespace tenebra::tint
