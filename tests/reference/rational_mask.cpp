#include "reference/rational_mask.h"

#include <gmpxx.h>

#include <array>
#include <cmath>

namespace tenebra::reference {
namespace {

using Q3 = std::array<mpq_class, 3>;

template <class V>
Q3 rational(const V& v) {
  return {mpq_class(double(v.x)), mpq_class(double(v.y)), mpq_class(double(v.z))};
}
Q3 along(const Q3& a, const mpq_class& t, const Q3& b) {
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
Q3 minus(const Q3& a, const Q3& b) {
  return along(a, -1, b);
}
mpq_class dot(const Q3& a, const Q3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Q3 cross(const Q3& a, const Q3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Plane {
  Q3 a, e, f, n;
  Plane(const TriangleView& view, std::uint32_t id) {
    const glm::uvec3 t = view.triangles[id];
    a = rational(view.positions[t.x]);
    e = minus(rational(view.positions[t.y]), a);
    f = minus(rational(view.positions[t.z]), a);
    n = cross(e, f);
  }
};

double largest_coordinate(const TriangleView& view, std::uint32_t id) {
  float largest = 0;
  for (int k = 0; k < 9; ++k)
    largest = std::max(largest, std::abs(view.positions[view.triangles[id][k / 3]][k % 3]));
  return largest;
}

double threshold(const TriangleView& view, std::uint32_t occluder, std::uint32_t receiver) {
  const double tau = std::sqrt(3.0) * 0x1p-24 * largest_coordinate(view, occluder) +
                     std::sqrt(3.0) * 0x1p-24 * largest_coordinate(view, receiver);
  const glm::uvec3 t = view.triangles[occluder];
  const glm::dvec3 a(view.positions[t.x]), e = glm::dvec3(view.positions[t.y]) - a,
                                           f = glm::dvec3(view.positions[t.z]) - a;
  return tau * glm::length(glm::cross(e, f));
}

/// Whether the segment or ray from `point` meets the closed triangle strictly before the light.
bool meets(const Plane& t, const Q3& point, const Q3& to_light, bool endless) {
  const mpq_class slope = dot(t.n, to_light);
  if (slope == 0) return false;
  const mpq_class where = dot(t.n, minus(t.a, point)) / slope;
  if (where <= 0 || (!endless && where >= 1)) return false;
  const Q3 x = minus(along(point, where, to_light), t.a);
  const mpq_class ee = dot(t.e, t.e), ef = dot(t.e, t.f), ff = dot(t.f, t.f), ex = dot(t.e, x),
                  fx = dot(t.f, x);
  const mpq_class area = ee * ff - ef * ef;
  const mpq_class beta = (ff * ex - ef * fx) / area, gamma = (ee * fx - ef * ex) / area;
  return beta >= 0 && gamma >= 0 && beta + gamma <= 1;
}

bool in_reach(const ShadowLight& light, const Q3& point) {
  if (light.directional) return true;
  const Q3 ray = minus(point, rational(light.position));
  const mpq_class square = dot(ray, ray), range(double(light.range_m)), cosine(double(light.spot_cos_outer));
  if (light.range_m > 0 && square > range * range) return false;
  if (light.spot_cos_outer <= -1.0f) return true;
  const mpq_class height = dot(ray, rational(light.spot_axis));
  const mpq_class left = height * abs(height), right = cosine * abs(cosine) * square;  // signed squares
  return left >= right;
}

}  // namespace

ShadowMask rational_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                         const ShadowLight& light, const HardShadowConfig& config) {
  ShadowMask mask(points.triangles.size(), 0);
  const bool by_ids = config.contact == ContactRule::triangle_ids;
  const Q3 light_q = rational(light.directional ? light.to_light : light.position);
  const auto to_light_of = [&](const Q3& from) { return light.directional ? light_q : minus(light_q, from); };
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id >= triangles.triangles.size()) continue;
    const Plane own(triangles, id);
    const Q3 eye = rational(view.orthographic ? -view.d0 : view.eye);
    const mpq_class sides =
        dot(own.n, to_light_of(own.a)) * dot(own.n, view.orthographic ? eye : minus(eye, own.a));
    const Q3 point = rational(points.positions[i]);
    if (sides <= 0 || !in_reach(light, point)) continue;
    bool blocked = false;
    for (std::uint32_t t = 0; t < triangles.triangles.size() && !blocked; ++t) {
      if (!triangles.casts_shadow.empty() && triangles.casts_shadow[t] == 0) continue;
      if (by_ids && t == id) continue;
      const Plane plane(triangles, t);
      const mpq_class towards = dot(plane.n, to_light_of(plane.a));
      if (towards == 0 || (config.cull_front && towards > 0)) continue;
      const mpq_class depth = (towards > 0 ? -1 : 1) * dot(plane.n, minus(point, plane.a));
      if (depth <= (by_ids ? threshold(triangles, t, id) : 0.0)) continue;
      blocked = meets(plane, point, to_light_of(point), light.directional);
    }
    mask[i] = blocked ? 0 : 255;
  }
  return mask;
}

}  // namespace tenebra::reference
