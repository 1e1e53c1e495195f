#include "ao/cast/ray_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "ao/cast/sphere_maps.h"

namespace tenebra::ao {
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

/// The number of the cell of a coordinate, which is in units of a cell. Shifted, so that walls at round
/// coordinates do not lie between two cells.
std::uint64_t cell_number(double coordinate) {
  constexpr double shift = 0.3819660113, most = 1e15;
  const double shifted = std::clamp(coordinate, -most, most) + shift;
  const auto whole = static_cast<std::int64_t>(shifted);  // towards zero
  return static_cast<std::uint64_t>(whole - (static_cast<double>(whole) > shifted ? 1 : 0));
}

}  // namespace

RayPattern make_ray_pattern(int rays, const glm::dvec2& shift) {
  std::vector<glm::dvec2> square;
  square.reserve(static_cast<std::size_t>(rays));
  for (int i = 0; i < rays; ++i)
    square.push_back({std::fmod((i + 0.5) / rays + shift.x, 1.0),
                      std::fmod((i + 0.5) / std::numbers::phi + shift.y, 1.0)});
  std::stable_sort(square.begin(), square.end(),
                   [](const glm::dvec2& a, const glm::dvec2& b) { return morton(a) < morton(b); });
  RayPattern pattern;
  pattern.rays = rays;
  pattern.batches.resize((square.size() + trees::batch_size - 1) / trees::batch_size);  // zeros
  for (std::size_t i = 0; i < square.size(); ++i) {
    const glm::vec3 d = hemisphere_from_square(glm::vec2(2.0 * square[i] - 1.0));
    RayPattern::Batch& batch = pattern.batches[i / trees::batch_size];
    batch.x[i % trees::batch_size] = d.x, batch.y[i % trees::batch_size] = d.y,
                batch.z[i % trees::batch_size] = d.z;
  }
  return pattern;
}

RayAxes turned_axes(const glm::vec3& normal, const glm::dvec3& position, double cell) {
  const double cells = 1 / cell;
  const std::uint64_t key = mixed(0xd1342543de82ef95u * cell_number(position.x * cells) +
                                  0xaf251af3b0f025b5u * cell_number(position.y * cells) +
                                  0x9e3779b97f4a7c15u * cell_number(position.z * cells) + 1);
  const float angle = (static_cast<float>(key >> 40) * 0x1p-24f - 0.5f) * static_cast<float>(0.25 * turn);
  const float x = angle * angle;
  // Series for an eighth of a turn either way, to a float's rounding; then whole quarters.
  float s = angle * (1 - x * (1.0f / 6 - x * (1.0f / 120 - x * (1.0f / 5040 - x * (1.0f / 362880)))));
  float c = 1 - x * (0.5f - x * (1.0f / 24 - x * (1.0f / 720 - x * (1.0f / 40320))));
  if ((key & 1) != 0) c = -std::exchange(s, c);
  if ((key & 2) != 0) c = -c, s = -s;
  const Frame frame = frame_around(normal);
  return {c * frame.x + s * frame.y, c * frame.y - s * frame.x, normal};
}

}  // namespace tenebra::ao
