#include "render/light_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "soft/light/light_places.h"

namespace tenebra::render {

namespace {

using glm::dvec3;

/// What some points of the light, each of which stands for `area_m2` of it, send to the pixels that see them.
struct PointsOfLight {
  std::span<const glm::vec3> places;
  std::span<const ShadowMask> masks;  // one per place
  dvec3 normal;
  double area_m2;
  float fraction;
  double weight;  // LightFrame::weight

  void add_to_pixel(std::size_t i, const dvec3& at, const dvec3& facing, SoftMask& out) const {
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (masks[k][i] == 0) continue;
      const dvec3 to = dvec3(places[k]) - weight * at;
      const double square = glm::dot(to, to), at_light = -glm::dot(normal, to),
                   at_point = glm::dot(facing, to);
      if (!(at_light > 0)) continue;  // behind the light
      out.visible_fraction[i] += fraction;
      if (at_point > 0)
        out.irradiance[i] += static_cast<float>(area_m2 * at_light * at_point / (square * square));
    }
  }
  void add(const VisiblePoints& points, std::span<const glm::vec3> normals, SoftMask& out) const {
    parallel::parallel_ranges(points.triangles.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (points.triangles[i] != no_triangle) add_to_pixel(i, points.positions[i], dvec3(normals[i]), out);
      }
    });
  }
};

}  // namespace

std::vector<glm::vec3> points_on_light(const AreaLight& light, int count) {
  const soft::LightPlaces places(light);
  std::vector<glm::vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    points.push_back(places.at((i + 0.5) / count, std::fmod((i + 0.5) / std::numbers::phi, 1.0)));
  return points;
}

bool LightPointShadows::trace(const VisiblePoints& points, std::span<const glm::vec3> normals,
                              const TriangleView& triangles, const AreaLight& light, int count,
                              const HardShadowConfig& config, SoftMask& out, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  stats_ = {};
  timings_ = {};
  out.visible_fraction.assign(points.triangles.size(), 0.0f);
  out.irradiance.assign(points.triangles.size(), 0.0f);
  places_ = points_on_light(light, count);
  const double area = light.at_infinity ? soft::LightPlaces(light).area() : light.area_m2;
  const double weight = light.at_infinity ? 0.0 : 1.0;
  for (std::size_t first = 0; first < places_.size(); first += masks_.size()) {
    const auto some = std::span(places_).subspan(first, std::min(masks_.size(), places_.size() - first));
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (!tracer_.trace_shadow_mask(points, triangles, soft::light_at(light, some[k]), config, masks_[k],
                                     stop))
        return false;
      stats_ += tracer_.stats();
      add_shadow_stages(timings_, tracer_.timings());
    }
    base::Stopwatch watch;
    const PointsOfLight lit{some,  masks_, light.normal, area / count, 1.0f / static_cast<float>(count),
                            weight};
    lit.add(points, normals, out);
    timings_.irradiance_ms += watch.lap_ms();
  }
  for (float& fraction : out.visible_fraction) fraction = std::min(fraction, 1.0f);
  return true;
}

}  // namespace tenebra::render
