#include "oracle/exact_soft.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "oracle/dyadic.h"
#include "oracle/exact_mask.h"
#include "oracle/vector.h"

namespace tenebra::oracle {

namespace {

using ExactVec = Vector<Dyadic>;

template <class V>
ExactVec exact(const V& v) {
  return ExactVec(v);
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
using Triangle = std::array<glm::vec3, 3>;
Triangle corners_of(const TriangleView& triangles, std::uint32_t id) {
  const glm::uvec3 t = triangles.triangles[id];
  return {triangles.positions[t.x], triangles.positions[t.y], triangles.positions[t.z]};
}
ExactVec plane_normal(const Triangle& t) {
  return cross(exact(t[1]) - exact(t[0]), exact(t[2]) - exact(t[0]));
}

template <class N>
N number(const Dyadic& value);
template <>
mpq_class number(const Dyadic& value) {
  return value.rational();
}
template <>
long double number(const Dyadic& value) {
  return value.rounded();
}
long double to_long_double(const long double& value) {
  return value;
}
/// Towards zero by 2^-63 at most, relatively.
long double to_long_double(const mpq_class& value) {
  const mpf_class wide(value, 192);
  const double high = wide.get_d();
  return static_cast<long double>(high) + mpf_class(wide - high).get_d();
}

/// The light's plane against a plane in space: direction . (Q - origin) over Q = centre + u ex + v ey; of a
/// sun direction . Q.
struct LightFrame {
  ExactVec centre, ex, ey;
  bool at_infinity;
  explicit LightFrame(const AreaLight& light)
      : centre(exact(light.centre)),
        ex(exact(light.ex)),
        ey(exact(light.ey)),
        at_infinity(light.at_infinity) {}
  ExactVec way_from(const ExactVec& origin) const { return at_infinity ? centre : centre - origin; }
  template <class N>
  HalfPlane<N> half_plane(const ExactVec& direction, const ExactVec& origin, int sign) const {
    const Dyadic s{static_cast<double>(sign)};
    return {number<N>(s * dot(direction, way_from(origin))), number<N>(s * dot(direction, ex)),
            number<N>(s * dot(direction, ey))};
  }
};

/// The part of the light's polygon that triangle `t` hides from `point`; `side`: sign of n.(point - t[0]).
template <class N>
Polygon<N> hidden_part(const Polygon<N>& base, const LightFrame& frame, const Triangle& t, const ExactVec& n,
                       const ExactVec& point, int side) {
  Polygon<N> part = clipped(base, frame.half_plane<N>(n, exact(t[0]), -side));
  for (std::size_t k = 0; k < 3 && !part.empty(); ++k) {
    // For X in the triangle det(a - P, b - P, X - P) has the sign of n.(t - P), that is of -side.
    const ExactVec a = exact(t[k]) - point, b = exact(t[(k + 1) % 3]) - point;
    part = clipped(part, frame.half_plane<N>(cross(a, b), point, -side));
  }
  return part;
}

Vector3l widened(const ExactVec& v) {
  return {v.x.rounded(), v.y.rounded(), v.z.rounded()};
}
long double dot(const Vector3l& a, const Vector3l& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// What `holes` leave of `base`; adds its area to `area`.
template <class N>
std::vector<Trapezoid> trapezoids_of(const Polygon<N>& base, const std::vector<Polygon<N>>& holes,
                                     long double& area) {
  std::vector<Trapezoid> out;
  for_each_trapezoid(base, holes,
                     [&](const N& left, const N& right, const SlabEdge<N>& low, const SlabEdge<N>& high) {
                       const N middle = N(N(left + right) / 2);
                       area += to_long_double(N(N(right - left) * N(high.at(middle) - low.at(middle))));
                       out.push_back({to_long_double(left), to_long_double(right),
                                      to_long_double(low.at(left)), to_long_double(low.at(right)),
                                      to_long_double(high.at(left)), to_long_double(high.at(right))});
                     });
  return out;
}

/// Integral of the cosine over what the trapezoids subtend above the plane of `normal`.
long double irradiance_of(const std::vector<Trapezoid>& visible, const LightFrame& frame,
                          const ExactVec& point, const Vector3l& normal) {
  const Vector3l c = widened(frame.way_from(point)), ex = widened(frame.ex), ey = widened(frame.ey);
  const HalfPlane<long double> above{dot(normal, c), dot(normal, ex), dot(normal, ey)};
  long double sum = 0;
  for (const Trapezoid& t : visible) {
    const Polygon<long double> part = clipped<long double>(
        {{t.left, t.low_left}, {t.right, t.low_right}, {t.right, t.high_right}, {t.left, t.high_left}},
        above);
    std::vector<Vector3l> around;
    for (const auto& [u, v] : part)
      around.push_back({c.x + u * ex.x + v * ey.x, c.y + u * ex.y + v * ey.y, c.z + u * ex.z + v * ey.z});
    sum += polygon_irradiance(around, normal);
  }
  return std::max(sum, 0.0L);
}

/// Bound of the error of a visible fraction by long doubles, eps = 2^-63. A line is rounded to 3 eps of the
/// base's extent; a cut at it (four a hole, one for the horizon) evaluates distances to 4 eps more and
/// displaces at most the whole cut by that; the sides of a slab are evaluated to 4 eps. Each displacement
/// costs at most the extent's length times it: 16 eps extent^2 a cut or chain.
double rounding_bound(const Polygon<long double>& outline, std::size_t holes) {
  long double extent = 0;
  for (const auto& p : outline)
    for (const auto& q : outline) extent = std::max(extent, std::hypot(p.x - q.x, p.y - q.y));
  const long double area = doubled_area(outline) / 2;
  return static_cast<double>(16 * 0x1p-63L * extent * extent / area *
                             static_cast<long double>(6 * holes + 2));
}

/// Which boxes may hold a part of a blocker: between the planes through the point and the outline's edges and
/// between the light's plane and the point. Conservative: see `slack`.
class Shaft {
public:
  Shaft(const AreaLight& light, const glm::dvec3& point) : point_(point) {
    std::vector<glm::dvec3> rays;
    for (const glm::dvec2& p : light.polygon) {
      const glm::dvec3 corner = light.centre + p.x * light.ex + p.y * light.ey;
      rays.push_back(light.at_infinity ? corner : corner - point);
      reach_ = std::max(reach_, glm::length(rays.back()));
      size_ = std::max(size_, glm::length(p));
    }
    size_ += glm::length(light.centre) + glm::length(point);
    for (std::size_t i = 0; i < rays.size(); ++i)
      sides_.push_back(glm::cross(rays[i], rays[(i + 1) % rays.size()]));
    // Counter-clockwise seen from where it shines: from the point the inside is at the negative side.
    normal_ = light.normal;
    height_ = light.at_infinity ? HUGE_VAL : glm::dot(normal_, point - light.centre);
  }
  bool may_hold(const glm::dvec3& low, const glm::dvec3& high) const {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t k = 0; k < 8; ++k)
      corners[k] = {(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                    (k & 4) != 0 ? high.z : low.z};
    return may_hold(corners);
  }
  template <std::size_t count>
  bool may_hold(const std::array<glm::dvec3, count>& corners) const {
    double farthest = 0, lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (const glm::dvec3& c : corners) {
      const double height = glm::dot(normal_, c - point_);
      farthest = std::max(farthest, glm::length(c - point_));
      lowest = std::min(lowest, height), highest = std::max(highest, height);
    }
    const double rounding = 0x1p-45 * (size_ + farthest);
    if (lowest > rounding || highest < -height_ - rounding) return false;
    for (const glm::dvec3& side : sides_) {
      double nearest = HUGE_VAL;
      for (const glm::dvec3& c : corners) nearest = std::min(nearest, glm::dot(side, c - point_));
      if (nearest > slack() * farthest + 0x1p-48 * glm::length(side) * (size_ + farthest)) return false;
    }
    return true;
  }

private:
  /// Error of a side: its rays are within 2^-49 size of the real ones (five roundings a coordinate, and the
  /// frame's few ulp), so their cross product is within twice that times the reach, and its own rounding.
  double slack() const { return 0x1p-47 * (size_ + reach_) * (reach_ + 0x1p-49 * size_); }

  glm::dvec3 point_, normal_{0.0};
  std::vector<glm::dvec3> sides_;
  double reach_ = 0, size_ = 0, height_ = 0;
};

}  // namespace

long double polygon_irradiance(const std::vector<Vector3l>& polygon, const Vector3l& normal) {
  long double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3l &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Vector3l e{b.x - a.x, b.y - a.y, b.z - a.z};
    const Vector3l n{a.y * e.z - a.z * e.y, a.z * e.x - a.x * e.z, a.x * e.y - a.y * e.x};
    const long double length = std::sqrt(dot(n, n));
    if (length > 0) sum += std::atan2(length, dot(a, b)) / length * dot(n, normal);
  }
  return -sum / 2;
}

ExactSoft::ExactSoft(const ViewRays& view, const TriangleView& triangles, const AreaLight& light)
    : view_(view), triangles_(triangles), light_(light), boxes_(triangles, {}) {
  std::vector<std::uint32_t> casting;
  for (std::uint32_t id = 0; id < triangles.triangles.size(); ++id) {
    const auto t = corners_of(triangles, id);
    const bool casts = triangles.casts_shadow.empty() || triangles.casts_shadow[id] != 0;
    if (casts && finite(t[0]) && finite(t[1]) && finite(t[2])) casting.push_back(id);
  }
  boxes_ = TriangleBoxes(triangles, std::move(casting));
}

int ExactSoft::eye_side(std::uint32_t id) const {
  const auto t = corners_of(triangles_, id);
  if (!finite(t[0]) || !finite(t[1]) || !finite(t[2])) return 0;
  const ExactVec n = plane_normal(t);
  return view_.orthographic ? dot(n, exact(-view_.d0)).sign() : dot(n, exact(view_.eye) - exact(t[0])).sign();
}

int ExactSoft::light_side(const glm::dvec3& point) const {
  if (light_.at_infinity) return 1;
  return dot(cross(exact(light_.ex), exact(light_.ey)), exact(point) - exact(light_.centre)).sign();
}

std::vector<std::uint32_t> ExactSoft::candidates(const glm::dvec3& point, std::uint32_t id) const {
  std::vector<std::uint32_t> found;
  const Shaft shaft(light_, point);
  boxes_.each_of([&](const glm::dvec3& low, const glm::dvec3& high) { return shaft.may_hold(low, high); },
                 [&](std::uint32_t t) {
                   const auto c = corners_of(triangles_, t);
                   const std::array<glm::dvec3, 3> wide{glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])};
                   if (t != id && shaft.may_hold(wide)) found.push_back(t);
                 });
  return found;
}

double ExactSoft::distance_in_sizes(const glm::dvec3& point) const {
  double size = 0;
  for (const glm::dvec2& v : light_.polygon) size = std::max({size, std::abs(v.x), std::abs(v.y)});
  const double distance = light_.at_infinity ? 1 : glm::length(point - light_.centre);
  return distance / (size * glm::length(light_.ex));
}

template <class N>
SoftAnswer ExactSoft::solve(const glm::dvec3& position, std::uint32_t id, glm::vec3 normal,
                            std::size_t most) const {
  SoftAnswer answer;
  const int side = eye_side(id), front = light_side(position);
  answer.at_plane = !light_.at_infinity &&
                    front != dot(exact(light_.normal), exact(position) - exact(light_.centre)).sign();
  if (side == 0 || front <= 0) return answer;
  const LightFrame frame(light_);
  const ExactVec point = exact(position);
  const auto own = corners_of(triangles_, id);
  const ExactVec own_normal = plane_normal(own);
  Polygon<N> outline;
  for (const glm::dvec2& p : light_.polygon) outline.push_back({N(p.x), N(p.y)});
  const Polygon<N> base = clipped(outline, frame.half_plane<N>(own_normal, exact(own[0]), side));
  const double tau = vertex_rounding(glm::dvec3(own[0]), glm::dvec3(own[1]), glm::dvec3(own[2]));
  std::vector<Polygon<N>> holes;
  const std::vector<std::uint32_t> occluders = candidates(position, id);
  for (const std::uint32_t t : occluders) {
    const auto c = corners_of(triangles_, t);
    const ExactVec n = plane_normal(c);
    const Dyadic height = dot(n, point - exact(c[0]));
    const glm::dvec3 wide[3] = {glm::dvec3(c[0]), glm::dvec3(c[1]), glm::dvec3(c[2])};
    const double tau_sum = vertex_rounding(wide[0], wide[1], wide[2]) + tau;
    const double theta = contact_height(wide[0], wide[1], wide[2], tau_sum);
    const Dyadic magnitude = height.sign() < 0 ? Dyadic(0.0) - height : height;
    if ((magnitude - Dyadic(theta)).sign() <= 0) continue;
    Polygon<N> part = hidden_part(base, frame, c, n, point, height.sign());
    if (!part.empty()) holes.push_back(std::move(part));
  }
  answer.candidates = occluders.size();
  answer.occluders = holes.size();
  answer.skipped = holes.size() > most;
  if (answer.skipped) return answer;
  long double visible = 0;
  answer.visible = trapezoids_of(base, holes, visible);
  const long double area = to_long_double(N(doubled_area(outline) / 2));
  answer.visible_fraction = static_cast<double>(std::clamp(visible / area, 0.0L, 1.0L));
  Polygon<long double> rounded;
  for (const glm::dvec2& p : light_.polygon) rounded.push_back({p.x, p.y});
  answer.error_bound = rounding_bound(rounded, holes.size()) + 0x1p-53;
  Vector3l up{normal.x, normal.y, normal.z};
  if (normal == glm::vec3(0)) {
    up = widened(own_normal);
    const long double length = std::sqrt(dot(up, up)) * static_cast<long double>(side);
    up = {up.x / length, up.y / length, up.z / length};
  }
  answer.irradiance = static_cast<double>(irradiance_of(answer.visible, frame, point, up));
  answer.unoccluded = static_cast<double>(irradiance_of(trapezoids_of(base, {}, visible), frame, point, up));
  return answer;
}

SoftAnswer ExactSoft::answer(const glm::dvec3& point, std::uint32_t id, const glm::vec3& normal,
                             SweepNumbers numbers, std::size_t most_occluders) const {
  if (id >= triangles_.triangles.size()) return {};
  return numbers == SweepNumbers::rational ? solve<mpq_class>(point, id, normal, most_occluders)
                                           : solve<long double>(point, id, normal, most_occluders);
}

}  // namespace tenebra::oracle
