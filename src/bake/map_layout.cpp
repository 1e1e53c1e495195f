#include "bake/map_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace tenebra::bake {
namespace {

constexpr double spare = 1.5, least_side = 8;
constexpr int none = -1, most_halvings = 15;

/// How often the map's side is halved for a surface at so many texels per metre; none: no area.
int halvings(double area_m2, double density, int size) {
  if (!(area_m2 > 0)) return none;
  const double wanted = density * std::sqrt(area_m2);
  const int most =
      std::clamp(std::ilogb(size / least_side), 0, most_halvings);  // small ones get more than their share
  return std::clamp(static_cast<int>(std::ceil(std::log2(size / wanted))), 0, most);
}

/// The part of the map that they take, all of it being 1.
double room(std::span<const double> areas_m2, double density, int size) {
  double sum = 0;
  for (const double area : areas_m2)
    if (const int k = halvings(area, density, size); k != none) sum += std::ldexp(1.0, -2 * k);
  return sum;
}

/// Even bits of a number.
double even_bits(std::uint64_t z) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= (z >> (2 * i) & 1) << i;
  return static_cast<double>(bits);
}

}  // namespace

std::optional<std::vector<MapSquare>> lay_out(std::span<const double> areas_m2, int size) {
  const double largest =
      areas_m2.empty() ? 0.0 : std::sqrt(*std::max_element(areas_m2.begin(), areas_m2.end()));
  std::vector<MapSquare> squares(areas_m2.size());
  if (!(largest > 0)) return squares;
  // The greatest of densities an eighth of an octave apart that leaves room for all.
  double density = size / largest;
  while (room(areas_m2, density, size) > 1) {
    density *= std::exp2(-0.125);
    if (density * largest < 1) return std::nullopt;
  }
  // Large ones first along a Z-shaped curve of cells of the smallest size: each begins where its own cells
  // do.
  std::vector<std::size_t> order(areas_m2.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return halvings(areas_m2[a], density, size) < halvings(areas_m2[b], density, size);
  });
  const double cell = std::ldexp(size, -most_halvings);
  std::uint64_t taken = 0;  // cells
  for (const std::size_t i : order) {
    const int k = halvings(areas_m2[i], density, size);
    if (k == none) continue;
    const double side = std::ldexp(size, -k);
    if (side < least_side) return std::nullopt;
    const glm::dvec2 corner = cell * glm::dvec2(even_bits(taken), even_bits(taken >> 1));
    squares[i] = {corner + spare, side - 2 * spare};
    taken += std::uint64_t{1} << (2 * (most_halvings - k));
  }
  return squares;
}

}  // namespace tenebra::bake
