#include "formats/file_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

glm::vec3 unit_or_zero(glm::vec3 n) {
  const float length = glm::length(n);
  return std::isfinite(length) && length > 0 ? n / length : glm::vec3(0);
}

}  // namespace tenebra::formats
