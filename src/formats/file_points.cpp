#include "formats/file_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/box.h"

namespace tenebra::formats {

void add_positions(std::span<const glm::dvec3> points, const FileFrame& frame, bool keep_unrounded,
                   Mesh& mesh) {
  mesh.positions.reserve(mesh.positions.size() + points.size());
  if (keep_unrounded) mesh.unrounded.reserve(mesh.unrounded.size() + points.size());
  for (const glm::dvec3& point : points) {
    const glm::dvec3 place = frame.to_scene(point);
    mesh.positions.emplace_back(place);
    if (keep_unrounded) mesh.unrounded.push_back(place);
  }
}

void warn_of_odd_positions(std::span<const glm::dvec3> points, Scene& scene) {
  constexpr double most = std::numeric_limits<float>::max();
  const auto is_odd = [](const glm::dvec3& p) {
    return !(std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most);
  };
  if (std::any_of(points.begin(), points.end(), is_odd))
    scene.warnings.push_back("Found vertices that are not finite; triangles that use them are dropped.");
}

void warn_of_floats(double largest_m, double side_m, Scene& scene) {
  const auto largest = static_cast<float>(largest_m);
  const double apart_m = std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
  if (scene.frame.origin == glm::dvec3(0.0) || !(apart_m > std::min(1e-3, 1e-3 * side_m))) return;
  scene.warnings.push_back(fmt::format(
      "This file's coordinates come as floats, which lie {:.3g} m apart at {:.0f} m: its shapes are "
      "rounded to that. Move it towards zero before it is written, or write OBJ, whose numbers are "
      "text.",
      apart_m, largest_m));
}

void warn_of_floats(std::span<const glm::dvec3> points, Scene& scene) {
  math::Box<double> bounds;
  for (const glm::dvec3& point : points)
    if (std::isfinite(point.x + point.y + point.z)) bounds.add(point * scene.frame.metres_per_unit);
  if (bounds.empty()) return;
  const int side = bounds.longest_side();
  warn_of_floats(bounds.largest_coordinate(), bounds.high[side] - bounds.low[side], scene);
}

glm::vec3 unit_or_zero(glm::vec3 n) {
  const float length = glm::length(n);
  return std::isfinite(length) && length > 0 ? n / length : glm::vec3(0);
}

}  // namespace tenebra::formats
