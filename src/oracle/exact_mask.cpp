#include "oracle/exact_mask.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle/dyadic.h"
#include "oracle/vector.h"
#include "parallel/parallel.h"

namespace tenebra::oracle {
namespace {

/// Sign of formula.operator()<T>(): by doubles if they can tell, else exactly (then `exact` counts it).
template <class Formula>
int sign_of(const Formula& formula, std::uint64_t& exact) {
  const int sign = formula(Bounded()).sign();
  if (sign != unknown_sign) return sign;
  ++exact;
  return formula(Dyadic()).sign();
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// n . (q - a), n = (b - a) x (c - a): on which side of the plane q is; a direction q (at infinity) if `far`.
int plane_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& q, bool far) {
  std::uint64_t exact = 0;
  return sign_of(
      [&]<class T>(T) {
        const Vector<T> origin(a);
        const Vector<T> n = cross(Vector<T>(b) - origin, Vector<T>(c) - origin);
        return far ? dot(n, Vector<T>(q)) : dot(n, Vector<T>(q) - origin);
      },
      exact);
}

std::vector<std::uint32_t> ids_of(const std::vector<std::int8_t>& flags) {
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] != 0) ids.push_back(static_cast<std::uint32_t>(i));
  return ids;
}

}  // namespace

double vertex_rounding(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 m = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  return std::sqrt(3.0) * 0x1p-24 * std::max(m.x, std::max(m.y, m.z));
}

double contact_height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double tau_sum) {
  const glm::dvec3 e = b - a, f = c - a;
  const double x = e.y * f.z - e.z * f.y, y = e.z * f.x - e.x * f.z, z = e.x * f.y - e.y * f.x;
  return tau_sum * std::sqrt(x * x + y * y + z * z);
}

ExactShadow::ExactShadow(const ViewRays& view, const OracleTriangles& triangles, const ShadowLight& light,
                         const HardShadowConfig& config)
    : view_(view), triangles_(triangles), light_(light), config_(config), boxes_(triangles, {}) {
  const std::size_t count = triangles.view.triangles.size();
  light_sides_.resize(count);
  casts_.resize(count);
  for (std::uint32_t id = 0; id < count; ++id) {
    light_sides_[id] = light_side(id);
    const bool flagged = triangles.view.casts_shadow.empty() || triangles.view.casts_shadow[id] != 0;
    const bool away = light_sides_[id] < 0;
    casts_[id] = light_sides_[id] != 0 && flagged && (away || !config.cull_front);
  }
  boxes_ = TriangleBoxes(triangles, ids_of(casts_));
}

ExactShadow::Corners ExactShadow::corners(std::uint32_t id) const {
  return {triangles_.corner(id, 0), triangles_.corner(id, 1), triangles_.corner(id, 2)};
}

/// +1: the light sees the front; -1: the back; 0: edge-on, no area, or not finite.
int ExactShadow::light_side(std::uint32_t id) const {
  const auto [a, b, c] = corners(id);
  if (!finite(a) || !finite(b) || !finite(c)) return 0;
  return plane_side(a, b, c, glm::dvec3(light_.directional ? light_.to_light : light_.position),
                    light_.directional);
}

int ExactShadow::eye_side(std::uint32_t id) const {
  const auto [a, b, c] = corners(id);
  return plane_side(a, b, c, view_.orthographic ? -glm::dvec3(view_.d0) : glm::dvec3(view_.eye),
                    view_.orthographic);
}

bool ExactShadow::in_reach(const glm::dvec3& point) const {
  if (light_.directional) return true;
  std::uint64_t exact = 0;
  const auto ray = [&]<class T>(T) { return Vector<T>(point) - Vector<T>(light_.position); };
  if (light_.range_m > 0) {
    const auto beyond = [&]<class T>(T t) {
      return dot(ray(t), ray(t)) - T(double(light_.range_m)) * T(double(light_.range_m));
    };
    if (sign_of(beyond, exact) > 0) return false;
  }
  if (light_.spot_cos_outer <= -1.0f) return true;
  const double cosine = light_.spot_cos_outer;
  const int along = sign_of([&]<class T>(T t) { return dot(ray(t), Vector<T>(light_.spot_axis)); }, exact);
  if (along >= 0 && cosine <= 0) return true;
  if (along < 0 && cosine >= 0) return false;
  const int squares = sign_of(
      [&]<class T>(T t) {
        const T height = dot(ray(t), Vector<T>(light_.spot_axis));
        return height * height - T(cosine) * T(cosine) * dot(ray(t), ray(t));
      },
      exact);
  return cosine > 0 ? squares >= 0 : squares <= 0;
}

bool ExactShadow::active(const glm::dvec3& point, std::uint32_t id) const {
  if (id >= light_sides_.size() || light_sides_[id] == 0) return false;
  return eye_side(id) == light_sides_[id] && in_reach(point);
}

bool ExactShadow::blocks(std::uint32_t occluder, const glm::dvec3& point, std::uint32_t id,
                         ExactMaskStats& stats) const {
  const bool by_ids = config_.contact == ContactRule::triangle_ids;
  if (casts_[occluder] == 0 || (by_ids && occluder == id)) return false;
  ++stats.pairs;
  const int side = light_sides_[occluder];
  const Corners triangle = corners(occluder);
  const glm::dvec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
  std::uint64_t exact = 0;
  // Depth below the plane, as seen from the light: -side n.(P - A) - theta > 0.
  const auto below = [&] {
    double theta = 0;
    if (by_ids) {
      const auto [ra, rb, rc] = corners(id);
      theta = contact_height(a, b, c, vertex_rounding(a, b, c) + vertex_rounding(ra, rb, rc));
    }
    return sign_of(
               [&]<class T>(T) {
                 const Vector<T> origin(a);
                 const Vector<T> n = cross(Vector<T>(b) - origin, Vector<T>(c) - origin);
                 return T(-double(side)) * dot(n, Vector<T>(point) - origin) - T(theta);
               },
               exact) > 0;
  };
  // Edges: the side of the plane through the light and q, r that the point is on; the third corner counts as
  // inside. With d the direction from the light (at infinity: -to_light), n.d has the sign of -side.
  const auto inside = [&](const glm::dvec3& q, const glm::dvec3& r) {
    return sign_of(
               [&]<class T>(T) {
                 const Vector<T> edge = Vector<T>(r) - Vector<T>(q);
                 if (light_.directional)
                   return T(double(side)) *
                          dot(cross(edge, Vector<T>(point) - Vector<T>(q)), Vector<T>(light_.to_light));
                 const Vector<T> l(light_.position);
                 return T(-double(side)) * dot(cross(Vector<T>(q) - l, edge), Vector<T>(point) - l);
               },
               exact) >= 0;
  };
  // Edges first: they are what most triangles near the ray fail.
  const bool result = inside(a, b) && inside(b, c) && inside(c, a) && below();
  stats.exact += exact > 0;
  return result;
}

std::uint32_t ExactShadow::blocker(const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const {
  const Segment segment = light_.directional ? Segment{point, glm::dvec3(light_.to_light), HUGE_VAL}
                                             : Segment{point, glm::dvec3(light_.position) - point, 1.0};
  std::uint32_t found = no_triangle;
  boxes_.any_of(segment, [&](std::uint32_t occluder) {
    if (!blocks(occluder, point, id, stats)) return false;
    found = occluder;
    return true;
  });
  return found;
}

std::uint32_t ExactShadow::blocker_among_all(const glm::dvec3& point, std::uint32_t id,
                                             ExactMaskStats& stats) const {
  for (std::uint32_t occluder = 0; occluder < casts_.size(); ++occluder)
    if (blocks(occluder, point, id, stats)) return occluder;
  return no_triangle;
}

ExactAnswer ExactShadow::answer(const glm::dvec3& point, std::uint32_t id, ExactMaskStats& stats) const {
  ++stats.samples;
  ExactAnswer answer;
  answer.active = active(point, id);
  if (!answer.active) return answer;
  ++stats.active;
  answer.blocker = blocker(point, id, stats);
  if (answer.blocker == no_triangle)
    answer.value = 255;
  else
    ++stats.shadowed;
  return answer;
}

ShadowMask exact_mask(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                      const ShadowLight& light, const HardShadowConfig& config, ExactMaskStats* stats) {
  const ExactShadow oracle(view, triangles, light, config);
  ShadowMask mask(points.triangles.size(), 0);
  constexpr std::size_t grain = 256;
  std::vector<ExactMaskStats> parts((mask.size() + grain - 1) / grain);
  parallel::parallel_ranges(mask.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (points.triangles[i] == no_triangle) continue;
      mask[i] = oracle.answer(points.positions[i], points.triangles[i], parts[first / grain]).value;
    }
  });
  if (stats != nullptr)
    for (const ExactMaskStats& part : parts) *stats += part;
  return mask;
}

}  // namespace tenebra::oracle
