// Seeded random numbers of the tests: the same on every platform (no distributions of the standard library).
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace tenebra::testing {

/// SplitMix64.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint32_t index(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * count) >> 32);
  }
  bool chance(double p) { return unit() < p; }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  ///< [0, 1)
  double in(double low, double high) { return low + (high - low) * unit(); }
  /// +-2^U(low, high): sizes of every order.
  double power_of_two(int low, int high) {
    const double size =
        std::ldexp(1 + unit(), low + static_cast<int>(index(static_cast<std::uint32_t>(high - low))));
    return chance(0.5) ? -size : size;
  }
  glm::dvec3 in_cube(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }
  /// Each coordinate +-2^U(low, high).
  glm::dvec3 wide(int low, int high) {
    return {power_of_two(low, high), power_of_two(low, high), power_of_two(low, high)};
  }
  /// Whole numbers -size..size: coplanar and collinear cases are common.
  glm::dvec3 grid(int size) {
    const auto number = [&] {
      return static_cast<double>(index(2 * static_cast<std::uint32_t>(size) + 1)) - size;
    };
    return {number(), number(), number()};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_cube(1);
      const double square = glm::dot(v, v);
      if (square > 1e-4 && square <= 1) return v / std::sqrt(square);
    }
  }

private:
  std::uint64_t state_;
};

}  // namespace tenebra::testing
