#include "bench/common/light_samples.h"

#include <algorithm>
#include <cmath>

#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

using glm::dvec2;
using glm::dvec3;

double cross(dvec2 a, dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

/// Maps the unit square onto the light so that equal areas stay equal.
class SquareToLight {
public:
  explicit SquareToLight(const AreaLight& light) : light_(light) {
    const auto& o = light.polygon;
    double sum = 0;
    for (std::size_t i = 2; i < o.size(); ++i) {
      sum += 0.5 * cross(o[i - 1] - o[0], o[i] - o[0]);
      area_up_to_.push_back(sum);
    }
    if (o.size() != 4) return;
    const double size = glm::length(o[2] - o[0]);
    parallelogram_ = glm::length(o[0] + o[2] - o[1] - o[3]) < 1e-5 * size;
    long_side_first_ = glm::length(o[1] - o[0]) >= glm::length(o[3] - o[0]);
  }

  dvec3 at(double u, double v) const {
    const dvec2 p = parallelogram_ ? on_parallelogram(u, v) : on_fan(u, v);
    return light_.centre + p.x * light_.ex + p.y * light_.ey;
  }

private:
  dvec2 on_parallelogram(double u, double v) const {
    const auto& o = light_.polygon;
    if (!long_side_first_) std::swap(u, v);
    return o[0] + u * (o[1] - o[0]) + v * (o[3] - o[0]);
  }
  /// u runs through the triangles of a fan by their areas and on across the triangle; v runs outwards.
  dvec2 on_fan(double u, double v) const {
    const auto& o = light_.polygon;
    const double area = u * area_up_to_.back();
    std::size_t t = 0;
    while (t + 1 < area_up_to_.size() && area >= area_up_to_[t]) ++t;
    const double before = t == 0 ? 0 : area_up_to_[t - 1];
    const double across = (area - before) / (area_up_to_[t] - before), out = std::sqrt(v);
    return o[0] + out * ((o[t + 1] - o[0]) + across * (o[t + 2] - o[t + 1]));
  }

  const AreaLight& light_;
  std::vector<double> area_up_to_;
  bool parallelogram_ = false;
  bool long_side_first_ = true;
};

struct Grid {
  std::size_t columns, rows;
};
/// As square as a power of two allows.
Grid grid_of(std::size_t cells) {
  std::size_t rows = 1;
  while (rows * rows * 4 <= cells) rows *= 2;
  return {cells / rows, rows};
}

/// Stores a jittered point of `cell`, rounded to float in the coordinates of the scene.
void put(LightSamples& samples, std::size_t at, const SquareToLight& map, Grid grid, std::size_t cell,
         testing::Random& random) {
  const double u =
      (static_cast<double>(cell % grid.columns) + random.unit()) / static_cast<double>(grid.columns);
  const double v =
      (static_cast<double>(cell / grid.columns) + random.unit()) / static_cast<double>(grid.rows);
  const dvec3 q = map.at(u, v);
  samples.x[at] = static_cast<float>(q.x);
  samples.y[at] = static_cast<float>(q.y);
  samples.z[at] = static_cast<float>(q.z);
}

LightSamples empty_samples(std::size_t per_pattern, std::size_t pattern_count, std::size_t places) {
  LightSamples samples{per_pattern, pattern_count, {}, {}, {}};
  for (auto* coordinate : {&samples.x, &samples.y, &samples.z}) coordinate->resize(places);
  return samples;
}

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

/// Every digit flipped or not by a hash of those before it.
double scrambled(std::uint32_t digits, std::uint32_t seed) {
  std::uint32_t x = reversed(digits);
  x += seed;
  for (const std::uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) x ^= x * factor;
  return (static_cast<double>(reversed(x)) + 0.5) * 0x1p-32;
}

constexpr std::size_t lanes = 16;
constexpr std::uint64_t seed = 2012;

}  // namespace

std::size_t scattered(std::size_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(z ^ (z >> 31));
}

LightSamples samples_by_pixel(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count) {
  const std::size_t stride = std::max(per_pattern, lanes);
  LightSamples samples = empty_samples(per_pattern, pattern_count, stride * pattern_count);
  const SquareToLight map(light);
  testing::Random random(seed);
  for (std::size_t p = 0; p < pattern_count; ++p) {
    for (std::size_t s = 0; s < stride; ++s)
      put(samples, p * stride + s, map, grid_of(per_pattern), s < per_pattern ? s : 0, random);
  }
  return samples;
}

LightSamples samples_by_tile(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count) {
  LightSamples samples = empty_samples(per_pattern, pattern_count, per_pattern * pattern_count);
  const SquareToLight map(light);
  testing::Random random(seed);
  for (std::size_t i = 0; i < samples.x.size(); ++i)
    put(samples, i, map, grid_of(per_pattern), i / lanes % per_pattern, random);
  return samples;
}

LightSamples sobol_by_tile(const AreaLight& light, std::size_t per_pattern, std::size_t pattern_count) {
  LightSamples samples = empty_samples(per_pattern, pattern_count, per_pattern * pattern_count);
  const SquareToLight map(light);
  testing::Random random(seed);
  for (std::size_t pattern = 0; pattern < pattern_count; ++pattern) {
    const auto seed_u = static_cast<std::uint32_t>(random.unit() * 0x1p32),
               seed_v = static_cast<std::uint32_t>(random.unit() * 0x1p32);
    for (std::size_t s = 0; s < per_pattern; ++s) {
      std::uint32_t u = 0, v = 0, digit = 1u << 31, column = 1u << 31;
      for (std::size_t i = s; i != 0; i >>= 1, digit >>= 1, column ^= column >> 1)
        if ((i & 1u) != 0) u ^= digit, v ^= column;
      const dvec3 q = map.at(scrambled(u, seed_u), scrambled(v, seed_v));
      const std::size_t at = (pattern / lanes * per_pattern + s) * lanes + pattern % lanes;
      samples.x[at] = static_cast<float>(q.x);
      samples.y[at] = static_cast<float>(q.y);
      samples.z[at] = static_cast<float>(q.z);
    }
  }
  return samples;
}

}  // namespace tenebra::bench
