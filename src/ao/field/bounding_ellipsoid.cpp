#include <algorithm>
#include <cmath>

#include "ao/field/displacement_field.h"
#include "ao/objects/sphere.h"

namespace tenebra::ao {

namespace {

constexpr double largest_coordinate = 1e18;
constexpr double most_stretch = 4;
constexpr int steps = 100;

/// Corners of triangles, each once.
std::vector<glm::dvec3> corners_of(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles) {
  std::vector<glm::dvec3> corners;
  std::vector<bool> seen(positions.size());
  for (const glm::uvec3& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] >= positions.size() || seen[t[k]]) continue;
      seen[t[k]] = true;
      const glm::dvec3 size = glm::abs(glm::dvec3(positions[t[k]]));
      if (size.x <= largest_coordinate && size.y <= largest_coordinate && size.z <= largest_coordinate)
        corners.emplace_back(positions[t[k]]);
    }
  }
  return corners;
}

/// Badoiu and Clarkson 2003: a step of 1 / (i + 1) towards the farthest corner.
Sphere small_sphere(std::span<const glm::dvec3> corners, glm::dvec3 start) {
  Sphere best{start, HUGE_VAL};
  glm::dvec3 centre = start;
  for (int i = 1; i <= steps; ++i) {
    double largest = -1;
    glm::dvec3 farthest = centre;
    for (const glm::dvec3& p : corners) {
      const double square = glm::dot(p - centre, p - centre);
      if (square > largest) largest = square, farthest = p;
    }
    if (std::sqrt(largest) < best.radius) best = {centre, std::sqrt(largest)};
    centre += (farthest - centre) / (i + 1.0);
  }
  return best;
}

}  // namespace

Ellipsoid bounding_ellipsoid(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                             FieldLayout layout) {
  std::vector<glm::dvec3> corners = corners_of(positions, triangles);
  if (corners.empty()) return {};
  glm::dvec3 low = corners[0], high = corners[0];
  for (const glm::dvec3& p : corners) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 extent = high - low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  glm::dvec3 stretch(1);
  if (layout == FieldLayout::chords && longest > 0) {
    stretch = glm::max(extent / longest, glm::dvec3(1 / most_stretch));
  }
  for (glm::dvec3& p : corners) p /= stretch;
  const Sphere sphere = small_sphere(corners, 0.5 * (low + high) / stretch);
  // This factor keeps all corners inside when the result, and the rays of a look-up, are rounded to float.
  return {sphere.centre * stretch, sphere.radius * (1 + 0x1p-20) * stretch};
}

}  // namespace tenebra::ao
