#include "render/light_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/stopwatch.h"
#include "parallel/parallel.h"

namespace tenebra::render {

namespace {

using glm::dvec2;
using glm::dvec3;

/// Where the line at `x` crosses a convex outline: from x() to y().
dvec2 chord_at(const std::vector<dvec2>& outline, double x) {
  dvec2 chord(INFINITY, -INFINITY);
  const auto meet = [&](double y) { chord = {std::min(chord.x, y), std::max(chord.y, y)}; };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if (a.x == x) meet(a.y);
    if ((a.x < x) != (b.x < x) && a.x != x && b.x != x) meet(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
  }
  return chord;
}

/// Part of the outline between two neighbouring vertices in x: a trapezoid.
struct Slab {
  double x, step;       ///< from x to x + step
  double width, slope;  ///< of the chord at x, and its growth with x
  double area() const { return step * (width + 0.5 * slope * step); }
  /// Where the area from the left is `part`.
  double x_at(double part) const {
    return x + 2 * part / (width + std::sqrt(std::max(0.0, width * width + 2 * slope * part)));
  }
};

std::vector<Slab> slabs_of(const std::vector<dvec2>& outline) {
  std::vector<double> xs;
  for (const dvec2& v : outline) xs.push_back(v.x);
  std::sort(xs.begin(), xs.end());
  std::vector<Slab> slabs;
  for (std::size_t i = 1; i < xs.size(); ++i) {
    if (xs[i] == xs[i - 1]) continue;
    const dvec2 from = chord_at(outline, xs[i - 1]), to = chord_at(outline, xs[i]);
    const double step = xs[i] - xs[i - 1], width = from.y - from.x;
    slabs.push_back({xs[i - 1], step, width, (to.y - to.x - width) / step});
  }
  return slabs;
}

/// What some points of the light, each of which stands for `area_m2` of it, send to the pixels that see them.
struct PointsOfLight {
  std::span<const glm::vec3> places;
  std::span<const ShadowMask> masks;  // one per place
  dvec3 normal;
  double area_m2;
  float fraction;

  void add_to_pixel(std::size_t i, const dvec3& at, const dvec3& facing, SoftMask& out) const {
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (masks[k][i] == 0) continue;
      const dvec3 to = dvec3(places[k]) - at;
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
  const std::vector<Slab> slabs = slabs_of(light.polygon);
  double total = 0;
  for (const Slab& slab : slabs) total += slab.area();
  std::vector<glm::vec3> points;
  for (int i = 0; i < count; ++i) {
    double part = (i + 0.5) / count * total;
    std::size_t k = 0;
    while (k + 1 < slabs.size() && part > slabs[k].area()) part -= slabs[k++].area();
    const double x = std::clamp(slabs[k].x_at(part), slabs[k].x, slabs[k].x + slabs[k].step);
    const dvec2 chord = chord_at(light.polygon, x);
    const double y = std::lerp(chord.x, chord.y, std::fmod((i + 0.5) / std::numbers::phi, 1.0));
    points.emplace_back(light.centre + x * light.ex + y * light.ey);
  }
  return points;
}

bool LightPointShadows::trace(const VisiblePoints& points, std::span<const glm::vec3> normals,
                              const ViewRays& view, const TriangleView& triangles, const AreaLight& light,
                              int count, const HardShadowConfig& config, SoftMask& out,
                              const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  stats_ = {};
  timings_ = {};
  out.visible_fraction.assign(points.triangles.size(), 0.0f);
  out.irradiance.assign(points.triangles.size(), 0.0f);
  places_ = points_on_light(light, count);
  for (std::size_t first = 0; first < places_.size(); first += masks_.size()) {
    const auto some = std::span(places_).subspan(first, std::min(masks_.size(), places_.size() - first));
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (!tracer_.trace_shadow_mask(points, view, triangles, {.position = some[k]}, config, masks_[k], stop))
        return false;
      stats_ += tracer_.stats();
      add_shadow_stages(timings_, tracer_.timings());
    }
    base::Stopwatch watch;
    PointsOfLight{some, masks_, light.normal, light.area_m2 / count, 1.0f / static_cast<float>(count)}.add(
        points, normals, out);
    timings_.irradiance_ms += watch.lap_ms();
  }
  for (float& fraction : out.visible_fraction) fraction = std::min(fraction, 1.0f);
  return true;
}

}  // namespace tenebra::render
