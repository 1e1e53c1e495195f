#include "bench/soft/soft_quality.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using Polygon = std::vector<dvec3>;

/// The exact answer's fractions are good to 1e-6 (support/soft_precision.h), and stored in float.
constexpr double fraction_tolerance = 2e-6;

/// The part of the polygon, around the point as origin, that lies above the plane through it.
Polygon above(const Polygon& polygon, const dvec3& normal) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double ha = glm::dot(a, normal), hb = glm::dot(b, normal);
    if (ha >= 0) kept.push_back(a);
    if ((ha < 0) != (hb < 0)) kept.push_back(a + (ha / (ha - hb)) * (b - a));
  }
  return kept;
}

double area(const Polygon& polygon) {
  dvec3 sum(0);
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * glm::length(sum);
}

double contour_integral(const Polygon& polygon, const dvec3& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const dvec3 across = glm::cross(a, b);
    const double length = glm::length(across);
    if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(across, normal) / length;
  }
  return 0.5 * std::abs(sum);
}

dvec3 face_normal(const BenchFrame& frame, std::uint32_t id) {
  const points::Corners c = points::corners_of(frame.triangles(), id);
  const dvec3 a(c.v[0]), across = glm::cross(dvec3(c.v[1]) - a, dvec3(c.v[2]) - a);
  const dvec3 to_eye = frame.view.orthographic ? -dvec3(frame.view.d0) : dvec3(frame.view.eye) - a;
  const double length = glm::length(across);
  if (!(length > 0)) return dvec3(0);
  return across / (glm::dot(across, to_eye) < 0 ? -length : length);
}

double percentile_999(std::vector<float> values) {
  if (values.empty()) return 1;
  const std::size_t rank = (values.size() * 999 + 999) / 1000 - 1;  // nearest rank
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank] > 0 ? static_cast<double>(values[rank]) : 1.0;
}

}  // namespace

Unoccluded unoccluded(const AreaLight& light, const dvec3& point, const dvec3& normal,
                      const dvec3& geometric) {
  const dvec3 way = light.at_infinity ? light.centre : light.centre - point;
  if (!(glm::dot(light.normal, way) < 0)) return {};
  Polygon polygon;
  for (const glm::dvec2& v : light.polygon) polygon.push_back(way + v.x * light.ex + v.y * light.ey);
  polygon = above(polygon, geometric);
  const double fraction = area(polygon) / light.area_m2;
  return {fraction, contour_integral(above(polygon, normal), normal)};
}

void finish_truth(const BenchFrame& frame, const AreaLight& light, Truth& truth) {
  const std::size_t count = frame.pixel_count();
  truth.penumbra.assign(count, 0);
  parallel::parallel_ranges(count, 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = frame.points.triangles[i];
      const auto seen = static_cast<double>(truth.mask.visible_fraction[i]);
      if (id == no_triangle || seen < fraction_tolerance) continue;
      const Unoccluded all =
          unoccluded(light, frame.points.positions[i], dvec3(frame.normals[i]), face_normal(frame, id));
      truth.penumbra[i] = seen < all.fraction - fraction_tolerance ? 1 : 0;
    }
  });
  truth.penumbra_count =
      static_cast<std::size_t>(std::count(truth.penumbra.begin(), truth.penumbra.end(), 1));
  std::vector<float> seen;
  for (std::size_t i = 0; i < count; ++i) {
    if (frame.points.triangles[i] != no_triangle) seen.push_back(truth.mask.irradiance[i]);
  }
  truth.white = percentile_999(std::move(seen));
}

SoftErrors errors_255(const Truth& truth, std::span<const float> irradiance, Where where) {
  double sum = 0, worst = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    if (where == Where::penumbra && truth.penumbra[i] == 0) continue;
    const double error =
        std::abs(static_cast<double>(irradiance[i]) - static_cast<double>(truth.mask.irradiance[i]));
    sum += error * error;
    worst = std::max(worst, std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
    ++count;
  }
  const double unit = 255 / truth.white;
  return {count == 0 ? 0 : unit * std::sqrt(sum / static_cast<double>(count)), unit * worst};
}

double penumbra_rmse_255(const Truth& truth, std::span<const float> irradiance) {
  return errors_255(truth, irradiance, Where::penumbra).rms;
}

double largest_error_255(const Truth& truth, std::span<const float> irradiance) {
  return errors_255(truth, irradiance, Where::everywhere).worst;
}

}  // namespace tenebra::bench
