// A seeded generator with the same numbers on every platform (no std distributions).
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace tenebra::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}

  std::uint64_t bits() {  // splitmix64
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }                   ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }

  glm::vec3 vec3(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }
  /// Each coordinate +-10^U(low, high).
  glm::vec3 wide_vec3(double low, double high) {
    glm::vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = static_cast<float>((below(2) ? 1 : -1) * std::pow(10.0, uniform(low, high)));
    return v;
  }
  /// Integers -size..size: coplanar and collinear cases are common.
  glm::ivec3 grid_vec3(int size) {
    const int x = below(2 * size + 1), y = below(2 * size + 1), z = below(2 * size + 1);
    return glm::ivec3(x, y, z) - size;
  }

 private:
  std::uint64_t state_;
};

}  // namespace tenebra::test
