#include "bench/ao/scenes/ao_scene_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "bench/ao/ao_rays.h"
#include "bench/common/ray_tile.h"

namespace tenebra::bench {
namespace {

using glm::dvec2;

constexpr int few_rays = 16;  // tables of more would leave the nearest caches

double fraction(double v) {
  return v - std::floor(v);
}

/// The two shortest steps between points of the lattice: they span a cell. (Lagrange's reduction.)
std::pair<dvec2, dvec2> cell(int rays) {
  dvec2 a(1.0 / rays, 1 / std::numbers::phi), b(0, 1);
  for (;;) {
    if (glm::dot(a, a) > glm::dot(b, b)) std::swap(a, b);
    const double times = std::round(glm::dot(a, b) / glm::dot(a, a));
    if (times == 0) return {a, b};
    b -= times * a;
  }
}

/// Back into the unit square by steps of the lattice: `rays` points on, it is one further in x, and not where
/// it was in y. So cells that cross the square's side fill it without gaps.
dvec2 wrapped(const dvec2& p, int rays) {
  const double over = std::floor(p.x);
  return {p.x - over, fraction(p.y - over * fraction(rays / std::numbers::phi))};
}

/// Point `index` of the first two dimensions of a Sobol sequence.
dvec2 sobol(unsigned index) {
  std::uint32_t x = 0, y = 0, direction = 1u << 31;
  for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1) {
    if ((index >> bit & 1u) == 0) continue;
    x ^= 1u << (31 - bit);
    y ^= direction;
  }
  return dvec2(x, y) * 0x1p-32;
}

/// Numbers 0..15 of 4x4 places so that any 2x2 of them are far apart.
unsigned dithered(int x, int y) {
  const auto two = [](int i, int j) { return static_cast<unsigned>(((i ^ j) & 1) * 2 + (j & 1)); };
  return 4 * two(x, y) + two(x / 2, y / 2);
}

/// Neighbours in the square one after the other.
std::vector<dvec2> lattice(int rays) {
  std::vector<dvec2> points;
  for (int i = 0; i < rays; ++i)
    points.emplace_back((i + 0.5) / rays, fraction((i + 0.5) / std::numbers::phi));
  const auto key = [](const dvec2& p) {
    std::uint32_t code = 0;
    const auto x = static_cast<std::uint32_t>(p.x * 256), y = static_cast<std::uint32_t>(p.y * 256);
    for (int bit = 0; bit < 8; ++bit) code |= (x >> bit & 1u) << (2 * bit) | (y >> bit & 1u) << (2 * bit + 1);
    return code;
  };
  std::stable_sort(points.begin(), points.end(),
                   [&](const dvec2& a, const dvec2& b) { return key(a) < key(b); });
  return points;
}

}  // namespace

AoScenePattern::AoScenePattern(int rays) : rays_(rays), side_(rays <= few_rays ? 4 : 1) {
  const auto [a, b] = cell(rays);
  const std::vector<dvec2> points = lattice(rays);
  const TileLanes lanes = TileLanes::of(TileShape::square);
  rows_.resize(std::size_t(side_ * side_) * points.size());
  for (int tile = 0; tile < side_ * side_; ++tile) {
    for (int lane = 0; lane < 16; ++lane) {
      const unsigned in_tile = dithered(static_cast<int>(lanes.x[lane]), static_cast<int>(lanes.y[lane]));
      const dvec2 place = sobol(in_tile + 16 * dithered(tile % side_, tile / side_)) - 0.5;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const dvec2 p = wrapped(points[i] + place.x * a + place.y * b, rays);
        const glm::vec3 d = cosine_direction(p.x, p.y);
        PatternRow& row = rows_[std::size_t(tile) * points.size() + i];
        row.x[lane] = d.x, row.y[lane] = d.y, row.z[lane] = d.z;
      }
    }
  }
}

}  // namespace tenebra::bench
