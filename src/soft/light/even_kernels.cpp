#include "soft/light/even_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft/light/even_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/float16-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

Vector16 load3(const float (&from)[3][EvenBlock::capacity]) {
  return {load<Float16>(from[0]), load<Float16>(from[1]), load<Float16>(from[2])};
}

/// Gauss' rule of 3 x 3 places. n.q / |q|^3 is a derivative of the harmonic 1 / |q|, whose derivatives of
/// order 7 are at most 7! / |q|^8 (Legendre's polynomials are at most 1), and the rule of three errs by the
/// sixth derivative along an axis over 15750, times 1/2 as a mean over [-1, 1]. So with half axes a, b, where
/// a^2 + b^2 <= 1, and the centre at distance d it is off by at most 5040 / 31500 (a^6 + b^6) / (d - 1)^8,
/// which from 7 on is less than 5e-6 / d^2; floats add less than 2e-6.
std::uint32_t even_by_rule(const EvenRectangle& light, EvenBlock& block) {
  const auto number = [](float value) { return broadcast<Float16>(value); };
  const Vector16 centre = load3(block.to_centre), normal = load3(block.normal);
  const Vector16 x = broadcast16(light.half_x), y = broadcast16(light.half_y);
  constexpr float places[3] = {-0.77459667f, 0.0f, 0.77459667f};
  constexpr float weights[3] = {5 / 18.0f, 8 / 18.0f, 5 / 18.0f};
  Float16 sum = number(0.0f);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector16 to = centre + number(places[i]) * x + number(places[j]) * y;
      const Float16 square = dot_unfused(to, to);
      sum = sum + number(weights[i] * weights[j]) * (dot_unfused(normal, to) / (square * sqrt(square)));
    }
  }
  store(number(light.area) * sum, block.irradiance);
  const Float16 distance2 = dot_unfused(centre, centre);
  const Float16 below = abs(dot_unfused(normal, x)) + abs(dot_unfused(normal, y));
  const auto usable =
      lt(number(49.0f), distance2) & lt(distance2, number(1e18f)) & lt(below, dot_unfused(normal, centre));
  return bits(usable);
}

}  // namespace

EvenKernel kernel() {
  return even_by_rule;
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::soft {

EvenRectangle even_rectangle(const AreaLight& light) {
  EvenRectangle found;
  if (light.polygon.size() != 4) return found;
  const auto& v = light.polygon;
  const glm::dvec2 x = 0.5 * (v[1] - v[0]), y = 0.5 * (v[3] - v[0]), skew = v[2] - v[1] - (v[3] - v[0]);
  found.unit_m = std::max(glm::length(x + y), glm::length(x - y));
  if (!(found.unit_m > 0) || glm::length(skew) > 1e-6 * found.unit_m) return found;
  const auto in_space = [&](const glm::dvec2& a) {
    return glm::vec3((a.x * light.ex + a.y * light.ey) / found.unit_m);
  };
  found.is_one = true;
  found.centre = light.centre;
  found.half_x = in_space(x);
  found.half_y = in_space(y);
  found.area = static_cast<float>(light.area_m2 / (found.unit_m * found.unit_m));
  return found;
}

void EvenBlock::add(const EvenRectangle& light, std::uint32_t pixel, const VisiblePoints& points,
                    std::span<const glm::vec3> normals) {
  const glm::dvec3 to = (light.centre - points.positions[pixel]) / light.unit_m;
  for (int c = 0; c < 3; ++c) {
    // A light that is no parallelogram is put at distance 0, too near for the rule.
    to_centre[c][count] = light.is_one ? static_cast<float>(to[c]) : 0.0f;
    normal[c][count] = normals[pixel][c];
  }
  pixels[count++] = pixel;
}

EvenKernel even_kernel(SimdLevel level) {
  return TENEBRA_DISPATCH(level, kernel)();
}

}  // namespace tenebra::soft
#endif
