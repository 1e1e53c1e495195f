#include "ao/adaptive/lattice_filter.h"

#include <algorithm>
#include <cmath>

namespace tenebra::ao {
namespace {

constexpr float same_surface = 0.25f;  ///< least alike() of those whose values are compared

/// 1 at 0, 0 at `radius`.
float bump(float distance, float radius) {
  const float t = std::max(0.0f, 1 - distance * distance / (radius * radius));
  return t * t;
}

}  // namespace

Said ask_lattice(const PixelSurfaces& surfaces, std::span<const float> values,
                 std::span<const float> nearness, int x, int y, int step) {
  const PixelSurface& here = surfaces.pixels[surfaces.index(x, y)];
  const int x0 = x / step * step, y0 = y / step * step;
  const float fx = static_cast<float>(x - x0) / static_cast<float>(step),
              fy = static_cast<float>(y - y0) / static_cast<float>(step);
  Said said;
  float sum = 0, total = 0, possible = 0;
  for (int j = -1; j <= 2; ++j) {
    const int py = y0 + j * step;
    if (py < 0 || py >= surfaces.height) continue;
    const float row = bump(static_cast<float>(j) - fy, 2);
    for (int i = -1; i <= 2; ++i) {
      const int px = x0 + i * step;
      if (px < 0 || px >= surfaces.width) continue;
      const float weight = row * bump(static_cast<float>(i) - fx, 2);
      if (weight == 0) continue;
      possible += weight;
      const std::size_t at = surfaces.index(px, py);
      const PixelSurface& there = surfaces.pixels[at];
      if (!there.there()) continue;
      const float same = alike(here, there);
      sum += weight * same * values[at], total += weight * same;
      const bool inner = (i == 0 || i == 1) && (j == 0 || j == 1);
      if (!inner || same < same_surface) continue;
      said.least = std::min(said.least, values[at]), said.most = std::max(said.most, values[at]);
      said.farthest = std::max(said.farthest, glm::length(there.at - here.at));
      said.nearness = std::min(said.nearness, nearness[at]);
    }
  }
  if (total > 0) said.value = sum / total, said.share = total / possible;
  return said;
}

Smoothed smoothed(const PixelSurfaces& surfaces, const PixelValues& pixels, int x, int y, int step,
                  float noise) {
  const std::size_t at = surfaces.index(x, y);
  const PixelSurface& here = surfaces.pixels[at];
  const float value = pixels.open[at], limit = 4 * noise;
  float sum = pixels.weight[at] * value, total = pixels.weight[at];
  for (int j = -2; j <= 2; ++j) {
    const int py = y + j * step;
    if (py < 0 || py >= surfaces.height) continue;
    for (int i = -2; i <= 2; ++i) {
      const int px = x + i * step;
      if ((i == 0 && j == 0) || px < 0 || px >= surfaces.width) continue;
      const std::size_t there = surfaces.index(px, py);
      const float weight = bump(static_cast<float>(i), 3) * bump(static_cast<float>(j), 3) *
                           bump(pixels.open[there] - value, limit);
      if (weight == 0 || !surfaces.pixels[there].there()) continue;
      const float same = weight * alike(here, surfaces.pixels[there]) * pixels.weight[there];
      sum += same * pixels.open[there], total += same;
    }
  }
  return {sum / total, total};
}

}  // namespace tenebra::ao
