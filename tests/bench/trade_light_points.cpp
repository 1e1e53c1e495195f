#include "trade_light_points.h"

#include <algorithm>

#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

/// Adds what one point of the light, which stands for `area_m2` of it, sends to the pixels that see it.
void add_point(const BenchFrame& frame, const AreaLight& light, const glm::dvec3& from, double area_m2,
               const ShadowMask& mask, std::span<float> irradiance) {
  parallel_ranges(mask.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (mask[i] == 0) continue;
      const glm::dvec3 to = from - frame.points.positions[i];
      const double square = glm::dot(to, to), at_light = -glm::dot(light.normal, to),
                   at_point = glm::dot(glm::dvec3(frame.normals[i]), to);
      if (!(at_light > 0) || !(at_point > 0)) continue;
      irradiance[i] += static_cast<float>(area_m2 * at_light * at_point / (square * square));
    }
  });
}

}  // namespace

LightPointMasks::LightPointMasks(const AreaLight& light, std::size_t count)
    : points_(samples_by_pixel(light, count, 1)) {}

void LightPointMasks::trace(const SoftView& view, ShadowTracer& tracer, std::span<float> irradiance) {
  const BenchFrame& frame = view.frame;
  std::fill(irradiance.begin(), irradiance.end(), 0.0f);
  for (std::size_t s = 0; s < points_.per_pattern; ++s) {
    const glm::vec3 from(points_.x[s], points_.y[s], points_.z[s]);
    const ShadowLight light{
        .position = from, .spot_axis = glm::vec3(view.light.normal), .spot_cos_outer = 0.0f};
    tracer.trace_shadow_mask(frame.points, frame.view, frame.triangles(), light, {}, mask_);
    add_point(frame, view.light, glm::dvec3(from),
              view.light.area_m2 / static_cast<double>(points_.per_pattern), mask_, irradiance);
  }
}

}  // namespace tenebra::bench
