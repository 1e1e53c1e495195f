// Hard masks of points. A point that does not say on which side of its triangle it is is on the light's.
#include <algorithm>
#include <cmath>
#include <utility>

#include "math/predicates.h"
#include "points/point_tiles.h"
#include "points/triangle_corners.h"
#include "query/tracer_state.h"

namespace tenebra {
namespace {

using glm::dvec3;

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Expected<void> check_light(const ShadowLight& light) {
  if (light.directional && (!finite(light.to_light) || light.to_light == glm::vec3(0.0f)))
    return base::fail("light: its direction is ({}, {}, {}), expected a finite one that is not zero",
                      light.to_light.x, light.to_light.y, light.to_light.z);
  if (light.directional) return {};
  const glm::vec3 size = glm::abs(light.position);
  if (!finite(light.position) || std::max({size.x, size.y, size.z}) > query::largest_coordinate)
    return base::fail("light: it is at ({}, {}, {}), expected finite coordinates of at most 1e18",
                      light.position.x, light.position.y, light.position.z);
  if (!(light.spot_cos_outer >= -1 && light.spot_cos_outer <= 1))
    return base::fail("light: the cosine of its cone is {}, expected -1 to 1", light.spot_cos_outer);
  constexpr float rounding = 1e-3f;
  if (light.spot_cos_outer > -1 && !(std::abs(glm::length(light.spot_axis) - 1) < rounding))
    return base::fail("light: the axis of its cone is {} long, expected 1", glm::length(light.spot_axis));
  if (!(light.range_m >= 0)) return base::fail("light: its range is {}, expected 0 or more", light.range_m);
  return {};
}

/// The side of triangles that the light is on; quick for a run of points on one.
class LightSide {
public:
  LightSide(const TriangleView& triangles, const ShadowLight& light) : triangles_(triangles), light_(light) {}
  int operator()(std::uint32_t triangle) {
    if (triangle != last_) {
      last_ = triangle;
      const points::Corners c = points::corners_of(triangles_, triangle);
      side_ = light_.directional ? math::direction_side(c.v[0], c.v[1], c.v[2], light_.to_light)
                                 : math::point_side(c.v[0], c.v[1], c.v[2], light_.position);
    }
    return side_;
  }

private:
  const TriangleView& triangles_;
  const ShadowLight& light_;
  std::uint32_t last_ = no_triangle;
  int side_ = 0;
};

/// Towards the light; at the light itself any direction will do.
dvec3 towards(const ShadowLight& light, const dvec3& point) {
  const dvec3 way = light.directional ? dvec3(light.to_light) : dvec3(light.position) - point;
  return way == dvec3(0.0) ? dvec3(0, 1, 0) : way;
}

/// The triangle and the side that a light asks point `i` about; no_triangle where it cannot reach it.
std::pair<std::uint32_t, int> asked_about(const query::TracerState& s, const QueryPoints& points,
                                          std::size_t i, const TriangleView& triangles,
                                          const ShadowLight& light, LightSide& light_side) {
  const std::uint32_t triangle = query::triangle_of(points, i);
  if (triangle != no_triangle) {
    const int side = query::said_side(points, i, triangles);
    return {triangle, side != 0 ? side : light_side(triangle)};
  }
  const dvec3 normal(query::normal_of(points, i));
  const bool behind = normal != dvec3(0.0) && !(glm::dot(normal, towards(light, s.place_of(points, i))) > 0);
  return {behind ? no_triangle : free_point, 0};
}

/// Sets what `light` asks about; whether any point's is another than before.
bool ask(query::TracerState& s, const QueryPoints& points, const query::Portion& portion,
         const TriangleView& triangles, const ShadowLight& light) {
  std::vector<std::uint8_t> changed(portion.count() / query::Portion::run + 1);  // of each run
  query::each_run(portion, [&](std::size_t first, std::size_t last) {
    LightSide light_side(triangles, light);
    bool other = false;
    for (std::size_t i = first; i < last; ++i) {
      const auto [triangle, side] = asked_about(s, points, portion.first() + i, triangles, light, light_side);
      const std::size_t pixel = portion.pixel(i);
      other |= s.seen.triangles[pixel] != triangle || s.seen.sides[pixel] != side;
      s.seen.triangles[pixel] = triangle, s.seen.sides[pixel] = static_cast<std::int8_t>(side);
    }
    changed[first / query::Portion::run] = other;
  });
  return std::find(changed.begin(), changed.end(), 1) != changed.end();
}

/// Whether no light changes what is asked about: all points are on a side that they say.
bool all_say_a_side(const QueryPoints& points) {
  const auto none = [](const auto& list, auto value) {
    return !list.empty() && std::find(list.begin(), list.end(), value) == list.end();
  };
  return none(points.triangles, no_triangle) && none(points.sides, std::int8_t{0});
}

/// The portion's part of the mask in the order of its points: four that follow each other are side by side.
void take_mask(const query::Portion& portion, const ShadowMask& from, std::span<std::uint8_t> to) {
  query::each_run(portion, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; i += 4)
      std::copy_n(&from[portion.pixel(i)], std::min<std::size_t>(4, last - i), &to[i]);
  });
}

/// Whether one portion holds all points, so that they need not be made again for another light.
bool fits_one_portion(const QueryPoints& points) {
  return !points.positions.empty() && query::Portion(points, 0).count() == points.positions.size();
}

}  // namespace

Expected<void> PointTracer::hard_mask(const Geometry& geometry, const QueryPoints& points,
                                      const ShadowLight& light, const HardShadowConfig& config,
                                      std::span<std::uint8_t> mask, const StopFlag* stop,
                                      const QueryProgress& progress) {
  const parallel::FloatEnvironment ieee;
  query::TracerState& s = *state_;
  if (mask.size() != points.positions.size())
    return base::fail("hard mask: found room for {} values, expected one for each of {} points", mask.size(),
                      points.positions.size());
  if (auto checked = check_light(light); !checked) return checked;
  if (auto checked = query::check_points(points, *geometry.data_); !checked) return checked;
  s.follow(geometry.data_);

  return query::in_portions(points, stop, progress, [&](const query::Portion& portion) -> Expected<void> {
    const TriangleView triangles = s.triangles();
    s.begin(points, portion);
    ask(s, points, portion, triangles, light);
    if (!s.hard.trace_shadow_mask(s.seen, triangles, light, config, s.mask, stop)) return base::stopped();
    take_mask(portion, s.mask, mask.subspan(portion.first()));
    return {};
  });
}

Expected<void> PointTracer::hard_masks(
    const Geometry& geometry, const QueryPoints& points, std::span<const ShadowLight> lights,
    const HardShadowConfig& config,
    const std::function<void(std::size_t, std::span<const std::uint8_t>)>& use, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  query::TracerState& s = *state_;
  std::vector<std::uint8_t> mask(points.positions.size());
  for (const ShadowLight& light : lights)
    if (auto checked = check_light(light); !checked) return checked;
  if (!fits_one_portion(points)) {
    for (std::size_t l = 0; l < lights.size(); ++l) {
      if (auto done = hard_mask(geometry, points, lights[l], config, mask, stop); !done) return done;
      use(l, mask);
    }
    return {};
  }
  if (auto checked = query::check_points(points, *geometry.data_); !checked) return checked;
  s.follow(geometry.data_);
  const TriangleView triangles = s.triangles();
  const query::Portion portion(points, 0);
  s.begin(points, portion);
  const bool asked_once = all_say_a_side(points);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    if (stop_requested(stop)) return base::stopped();
    const bool changed = (l == 0 || !asked_once) && ask(s, points, portion, triangles, lights[l]);
    if (changed && config.variant == Variant::tiles)
      points::make_point_tiles(s.seen, triangles, *s.seen.tiles);
    if (!s.hard.trace_shadow_mask(s.seen, triangles, lights[l], config, s.mask, stop)) return base::stopped();
    take_mask(portion, s.mask, mask);
    use(l, mask);
  }
  s.seen.tiles.clear();
  return {};
}

}  // namespace tenebra
