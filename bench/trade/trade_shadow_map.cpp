#include "bench/trade/trade_shadow_map.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::bench {
namespace {

using glm::vec3;

struct Lookup {
  const DepthMap& map;
  const HardView& view;
  float bias;  // texels

  bool lit(std::size_t pixel, std::uint32_t id) const {
    const points::Corners c = points::corners_of(view.frame.triangles(), id);
    const vec3 n = glm::cross(c.v[1] - c.v[0], c.v[2] - c.v[0]);
    const glm::dvec3& point = view.frame.points.positions[pixel];
    const vec3 way = view.light.directional ? view.light.to_light : vec3(glm::dvec3(map.light) - point);
    const float towards = glm::dot(n, way), seen = glm::dot(n, view.frame.view.eye - c.v[0]);
    if (!(towards * seen > 0)) return false;
    const DepthMap::Place at = map.place_of(point);
    const auto texel = [&](float x) { return std::clamp(static_cast<int>(x), 0, map.size - 1); };
    const float nearest = map.distance(at.face, texel(at.x), texel(at.y));
    const float cosine = std::abs(towards) / (glm::length(n) * glm::length(way));
    const float slope =
        std::min(std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / cosine, ShadowMapBias::steepest);
    return !(nearest < at.t - bias * at.texel_m * (1 + slope));
  }
};

}  // namespace

void shadow_from_map(const DepthMap& map, const HardView& view, ShadowMapBias bias, ShadowMask& mask) {
  const VisiblePoints& points = view.frame.points;
  const Lookup lookup{map, view, static_cast<float>(bias.texels)};
  mask.resize(points.triangles.size());
  parallel::parallel_ranges(mask.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = points.triangles[i];
      mask[i] = id != no_triangle && lookup.lit(i, id) ? 255 : 0;
    }
  });
}

std::size_t differing_pixels(const ShadowMask& a, const ShadowMask& b) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differing += a[i] != b[i] ? 1 : 0;
  return differing;
}

ShadowMapBias best_bias(const DepthMap& map, const HardView& view, const ShadowMask& exact) {
  std::vector<double> candidates{0};
  for (double texels = 1.0 / 32; texels <= 8; texels *= std::sqrt(2.0)) candidates.push_back(texels);
  ShadowMapBias best;
  std::size_t fewest = exact.size() + 1;
  ShadowMask mask;
  for (const double texels : candidates) {
    shadow_from_map(map, view, {texels}, mask);
    const std::size_t wrong = differing_pixels(mask, exact);
    if (wrong >= fewest) continue;
    fewest = wrong;
    best.texels = texels;
  }
  return best;
}

}  // namespace tenebra::bench
