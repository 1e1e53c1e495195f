#include "ao/ray_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "ao/sphere_maps.h"

namespace tenebra {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// Bits of two coordinates interleaved: neighbours in the square come close together.
std::uint32_t morton(glm::dvec2 p) {
  const auto x = static_cast<std::uint32_t>(p.x * 32768), y = static_cast<std::uint32_t>(p.y * 32768);
  std::uint32_t code = 0;
  for (int bit = 0; bit < 15; ++bit) {
    code |= (x >> bit & 1) << (2 * bit);
    code |= (y >> bit & 1) << (2 * bit + 1);
  }
  return code;
}

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Cell of a coordinate. Shifted, so that walls at round coordinates do not lie between two cells.
std::uint64_t cell_number(double coordinate, double cell) {
  constexpr double shift = 0.3819660113, most = 1e15;
  return static_cast<std::uint64_t>(
      static_cast<std::int64_t>(std::floor(std::clamp(coordinate / cell, -most, most) + shift)));
}

}  // namespace

RayPattern make_ray_pattern(int rays) {
  std::vector<glm::dvec2> square;
  for (int i = 0; i < rays; ++i)
    square.push_back({(i + 0.5) / rays, std::fmod((i + 0.5) / std::numbers::phi, 1.0)});
  std::stable_sort(square.begin(), square.end(),
                   [](const glm::dvec2& a, const glm::dvec2& b) { return morton(a) < morton(b); });
  RayPattern pattern;
  pattern.rays = rays;
  pattern.batches.resize((square.size() + batch_size - 1) / batch_size);  // zeros
  for (std::size_t i = 0; i < square.size(); ++i) {
    const glm::vec3 d = hemisphere_from_square(glm::vec2(2.0 * square[i] - 1.0));
    RayPattern::Batch& batch = pattern.batches[i / batch_size];
    batch.x[i % batch_size] = d.x, batch.y[i % batch_size] = d.y, batch.z[i % batch_size] = d.z;
  }
  return pattern;
}

RayAxes turned_axes(const glm::vec3& normal, const glm::dvec3& position, double cell) {
  std::uint64_t key = mixed(cell_number(position.x, cell) + 0x9e3779b97f4a7c15u);
  key = mixed(key ^ cell_number(position.y, cell));
  key = mixed(key ^ cell_number(position.z, cell));
  const double angle = (static_cast<double>(key >> 11) * 0x1p-53 - 0.5) * (0.25 * turn), x = angle * angle;
  // Series for an eighth of a turn either way, beyond float; then whole quarters.
  auto s =
      static_cast<float>(angle * (1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110))))));
  auto c = static_cast<float>(1 - x / 2 * (1 - x / 12 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90)))));
  if ((key & 1) != 0) c = -std::exchange(s, c);
  if ((key & 2) != 0) c = -c, s = -s;
  const Frame frame = frame_around(normal);
  return {c * frame.x + s * frame.y, c * frame.y - s * frame.x, normal};
}

}  // namespace tenebra
