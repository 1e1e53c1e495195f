#include "shadow/rays/sightlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/box.h"
#include "math/expansion.h"
#include "math/l1_norm.h"
#include "math/predicates.h"
#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/decision/lifted_points.h"
#include "shadow/decision/triangle_planes.h"
#include "shadow/rays/shadow_rays.h"

namespace tenebra::shadow {
namespace {

using glm::dvec3;
using glm::vec3;
using points::Corners;

constexpr std::size_t triangles_a_range = 4096;

/// Bounds of places, exact: floats and doubles are only compared.
using Box = math::Box<double>;

bool misses(const Box& box, const Corners& c) {
  for (int k = 0; k < 3; ++k) {
    const float a = c.v[0][k], b = c.v[1][k], d = c.v[2][k];
    if ((a < box.low[k] && b < box.low[k] && d < box.low[k]) ||
        (a > box.high[k] && b > box.high[k] && d > box.high[k]))
      return true;
  }
  return false;
}

/// Bounds of the way from a sample to a light.
Box box_of(const dvec3& point, const RaySource& source) {
  Box box;
  box.add(point);
  if (!source.directional) {
    box.add(dvec3(source.light));
    return box;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (source.light[k] > 0) box.high[k] = infinity;
    if (source.light[k] < 0) box.low[k] = -infinity;
  }
  return box;
}

/// An interval of a coordinate.
struct Interval {
  double low = 0, high = 0;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Ways that leave one sample, as seen along them: on the plane across they are near 0, and few triangles
/// are. Conservative. For a corner at distance d (L1, rounded: off by 2^-53 of itself) the products with the
/// unit axes u and v carry at most 4 roundings: 2^-50 d is more than they can be off by. A way meets a
/// triangle nowhere farther than the farthest corner, so what u and v lack to be across a direction, 2^-51 at
/// most, moves it by less than that again; 2^-48 d covers both twice over.
class Bundle {
public:
  void add(const dvec3& point, const RaySource& source) {
    const dvec3 way = source.directional ? dvec3(source.light) : dvec3(source.light) - point;
    if (ways_.empty()) point_ = point;
    mixed_ |= source.directional && !ways_.empty();
    mixed_ |= !ways_.empty() && endless_;
    endless_ = source.directional;
    ways_.push_back(way);
  }

  /// Once all ways are added.
  void aim() {
    dvec3 middle(0);
    for (const dvec3& way : ways_) middle += way / static_cast<double>(ways_.size());
    const double length = std::sqrt(glm::dot(middle, middle));
    aimed_ = !mixed_ && length > 0 && std::isfinite(length);
    if (!aimed_) return;
    const dvec3 along = middle / length;
    const dvec3 other = std::abs(along.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    u_ = glm::normalize(glm::cross(along, other));
    v_ = glm::cross(along, u_);
    for (const dvec3& way : ways_) {
      const double off = endless_ ? 0.0 : 0x1p-48 * math::l1_norm(way);
      for (const double sign : {-off, off}) {
        if (!endless_) across_u_.add(glm::dot(way, u_) + sign), across_v_.add(glm::dot(way, v_) + sign);
      }
    }
  }

  bool misses(const Corners& c) const {
    if (!aimed_) return false;
    const dvec3 a = dvec3(c.v[0]) - point_, b = dvec3(c.v[1]) - point_, d = dvec3(c.v[2]) - point_;
    const double off = 0x1p-48 * std::max({math::l1_norm(a), math::l1_norm(b), math::l1_norm(d)});
    return beside(glm::dot(a, u_), glm::dot(b, u_), glm::dot(d, u_), across_u_, off) ||
           beside(glm::dot(a, v_), glm::dot(b, v_), glm::dot(d, v_), across_v_, off);
  }

private:
  static bool beside(double a, double b, double c, const Interval& ways, double off) {
    return std::max({a, b, c}) + off < ways.low || std::min({a, b, c}) - off > ways.high;
  }

  dvec3 point_{0.0}, u_{0.0}, v_{0.0};
  std::vector<dvec3> ways_;
  Interval across_u_, across_v_;  // of the ways; they hold 0, the sample
  bool endless_ = false, mixed_ = false, aimed_ = false;
};

/// The way to one light.
struct Way {
  RaySource source;
  Box box;
  Sightline line;
  bool open = false;  // the light reaches the sample: triangles decide
};

class Search {
public:
  Search(const Sample& sample, const TriangleView& triangles, const HardShadowConfig& config)
      : sample_(sample),
        triangles_(triangles),
        config_(config),
        by_ids_(config.contact == ContactRule::triangle_ids),
        tau_own_(by_ids_ ? points::own_tolerance(triangles, sample.triangle, sample.point) : 0.0) {}

  bool casts(std::uint32_t id) const {
    return (!by_ids_ || id != sample_.triangle) &&
           (triangles_.casts_shadow.empty() || triangles_.casts_shadow[id] != 0);
  }

  /// Whether triangle `c` blocks the way, exactly. The way then meets the triangle, and so do their boxes.
  bool blocks(const Corners& c, const Way& way) const {
    if (misses(way.box, c)) return false;
    int edges = 0;  // the sign that the edges have so far; 0: on all of them
    for (int k = 0; k < 3; ++k) {
      const int sign = edge_sign(c, k, way.source);
      if (sign * edges < 0) return false;
      if (sign != 0) edges = sign;
    }
    const int side = light_side(c.v, way.source);
    if (side == 0 || side * edges < 0 || (config_.cull_front && side < 0)) return false;
    const double threshold =
        by_ids_ ? points::contact_threshold(c.v, points::rounding_tolerance(c.v), tau_own_) : 0.0;
    return math::plane_excess(c.v[0], c.v[1], c.v[2], sample_.point, side, threshold) > 0;
  }

private:
  int edge_sign(const Corners& c, int k, const RaySource& source) const {
    const vec3 &a = c.v[k], &b = c.v[(k + 1) % 3];
    return source.directional ? math::edge_side_infinite(source.light, a, b, sample_.point)
                              : math::edge_side(source.light, a, b, sample_.point);
  }

  const Sample& sample_;
  const TriangleView& triangles_;
  const HardShadowConfig& config_;
  bool by_ids_;
  double tau_own_;
};

/// Where a way meets a triangle's plane: at over/whole of the way from the sample, exactly, both positive. Of
/// a directional light the way is measured in lengths of its direction.
struct Meeting {
  math::Expansion over, whole;
};
Meeting meeting_of(const Corners& c, const dvec3& point, const RaySource& source) {
  const math::ExactVector n =
      cross(math::exact_difference(c.v[1], c.v[0]), math::exact_difference(c.v[2], c.v[0]));
  Meeting m{dot(n, math::exact_difference(c.v[0], point)),
            dot(n, source.directional ? math::exact_vector(source.light)
                                      : math::exact_difference(source.light, point))};
  if (m.whole.sign() < 0) m = {-m.over, -m.whole};  // both have the same sign, made positive
  return m;
}

bool earlier(const Meeting& a, const Meeting& b) {
  return (a.over * b.whole - b.over * a.whole).sign() < 0;
}

dvec3 place_of(const Corners& c, const dvec3& point, const RaySource& source) {
  const dvec3 n = glm::cross(dvec3(c.v[1]) - dvec3(c.v[0]), dvec3(c.v[2]) - dvec3(c.v[0]));
  const dvec3 way = source.directional ? dvec3(source.light) : dvec3(source.light) - point;
  const double t = glm::dot(n, dvec3(c.v[0]) - point) / glm::dot(n, way);
  return std::isfinite(t) ? point + t * way : dvec3(c.v[0]);
}

/// `blockers`: ids in ascending order, not empty.
void take_first(const std::vector<std::uint32_t>& blockers, const Sample& sample,
                const TriangleView& triangles, Way& way) {
  way.line.sight = LightSight::blocked;
  way.line.blockers = static_cast<std::uint32_t>(blockers.size());
  Meeting first;
  for (const std::uint32_t id : blockers) {
    Meeting meeting = meeting_of(points::corners_of(triangles, id), sample.point, way.source);
    if (way.line.first != no_triangle && !earlier(meeting, first)) continue;
    way.line.first = id;
    first = std::move(meeting);
  }
  way.line.met_at = place_of(points::corners_of(triangles, way.line.first), sample.point, way.source);
}

/// Whether light may come from where `light` is: the sample is active, but for cone and range.
bool faces(const Sample& sample, const TriangleView& triangles, const RaySource& source,
           ContactRule contact) {
  if (sample.triangle == free_point) return true;
  const Corners own = points::corners_of(triangles, sample.triangle);
  const int side = light_side(own.v, source);
  if (side != 0 && sample.side == -side) return true;
  return contact == ContactRule::triangle_ids &&
         faces_beyond(triangles, sample.triangle, sample.side, source) == Faces::beyond &&
         SeesPast(triangles, sample.triangle, sample.side, source).from(sample.point);
}

Way way_to(const ShadowLight& light, const Sample& sample, const TriangleView& triangles,
           ContactRule contact) {
  Way way{.source = ray_source(light)};
  if (!faces(sample, triangles, way.source, contact)) {
    way.line.sight = LightSight::faces_away;
  } else if (!in_reach(sample.point - way.source.origin, light)) {
    way.line.sight = LightSight::out_of_reach;
  } else {
    way.open = true;
    way.box = box_of(sample.point, way.source);
  }
  return way;
}

}  // namespace

std::vector<Sightline> find_sightlines(const Sample& sample, const TriangleView& triangles,
                                       std::span<const ShadowLight> lights, const HardShadowConfig& config) {
  const parallel::FloatEnvironment ieee;
  std::vector<Way> ways;
  Box all;
  Bundle bundle;
  for (const ShadowLight& light : lights) {
    ways.push_back(way_to(light, sample, triangles, config.contact));
    if (!ways.back().open) continue;
    all.add(ways.back().box);
    bundle.add(sample.point, ways.back().source);
  }
  bundle.aim();
  const Search search(sample, triangles, config);
  const std::size_t count = triangles.triangles.size();
  const std::size_t ranges = (count + triangles_a_range - 1) / triangles_a_range;
  std::vector<std::vector<std::vector<std::uint32_t>>> found(ranges);  // of each range, for each light
  parallel::parallel_ranges(count, triangles_a_range, [&](std::size_t begin, std::size_t end) {
    auto& blockers = found[begin / triangles_a_range];
    blockers.resize(ways.size());
    for (auto id = static_cast<std::uint32_t>(begin); id < end; ++id) {
      if (!search.casts(id)) continue;
      const Corners c = points::corners_of(triangles, id);
      if (misses(all, c) || bundle.misses(c)) continue;
      for (std::size_t i = 0; i < ways.size(); ++i) {
        if (ways[i].open && search.blocks(c, ways[i])) blockers[i].push_back(id);
      }
    }
  });

  std::vector<Sightline> lines;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    std::vector<std::uint32_t> blockers;
    for (const auto& of_range : found)
      blockers.insert(blockers.end(), of_range[i].begin(), of_range[i].end());
    if (!blockers.empty()) take_first(blockers, sample, triangles, ways[i]);
    lines.push_back(ways[i].line);
  }
  return lines;
}

}  // namespace tenebra::shadow
