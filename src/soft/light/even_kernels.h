// even_irradiance at sixteen points that are far from the light for its size, by Gauss' rule. Internal to
// soft.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include <tenebra/area_light.h>
#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>

namespace tenebra::soft {

/// A light that is a parallelogram, in units of its longer half diagonal: the rule takes no other lights.
struct EvenRectangle {
  bool is_one = false;
  glm::dvec3 centre{0.0};
  double unit_m = 1;
  glm::vec3 half_x{0.0f}, half_y{0.0f};
  float area = 0;
};
EvenRectangle even_rectangle(const AreaLight& light);

struct EvenBlock {
  static constexpr std::size_t capacity = 16;
  std::size_t count = 0;
  std::uint32_t pixels[capacity] = {};
  alignas(64) float to_centre[3][capacity] = {};
  alignas(64) float normal[3][capacity] = {};
  alignas(64) float irradiance[capacity] = {};

  void add(const EvenRectangle& light, std::uint32_t pixel, const VisiblePoints& points,
           std::span<const glm::vec3> normals);
};

/// Fills block.irradiance, and returns the bits of the points for which it is right, within 1e-5 of area /
/// distance^2: those whose horizon does not cut the light, from 7 to 1e9 half diagonals away.
using EvenKernel = std::uint32_t (*)(const EvenRectangle& light, EvenBlock& block);
EvenKernel even_kernel(SimdLevel level);

}  // namespace tenebra::soft
