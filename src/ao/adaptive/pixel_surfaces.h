// The surfaces that pixels show, to tell which pixels may stand in for each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ao/receivers/receiver_sets.h"

namespace tenebra::ao {

struct PixelSurface {
  glm::vec3 at{0.0f};      ///< in units of the reach, from a point of the frame
  glm::vec3 normal{0.0f};  ///< unit, of shading; zero: there is no receiver
  bool there() const { return normal != glm::vec3(0.0f); }
};

/// 0..1: how far two points lie in one plane, face alike and are close to each other compared with the reach.
/// Occlusion may change by about as much as any of these does.
inline float alike(const PixelSurface& a, const PixelSurface& b) {
  const glm::vec3 d = b.at - a.at;
  const float turned = std::max(0.0f, glm::dot(a.normal, b.normal));
  const float off = std::max(std::abs(glm::dot(d, a.normal)), std::abs(glm::dot(d, b.normal)));
  const float t2 = turned * turned, t4 = t2 * t2, square = glm::dot(d, d);
  // Not level where there is a ledge, however low: along an arc the mean of the normals is across the chord.
  const float rise = 4 * glm::dot(d, a.normal + b.normal);
  const float level = std::max(0.0f, 1 - rise * rise / std::max(square, 1e-20f));
  return t4 * t4 * level * std::max(0.0f, 1 - 16 * off) * std::max(0.0f, 1 - 4 * square);
}

struct PixelSurfaces {
  int width = 0, height = 0;
  std::vector<PixelSurface> pixels;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

void find_surfaces(const AoFrame& frame, double reach, PixelSurfaces& out);

}  // namespace tenebra::ao
