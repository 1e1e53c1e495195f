// What pixels' centres say of the hard shadows around them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "shade/light_terms.h"

namespace tenebra::render {

/// Which lights reach a sample: a bit for each. Lights without a mask have 0.
using LitBits = std::uint32_t;
constexpr std::size_t most_lit_bits = 32;

struct CentreShadows {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> ids;
  std::span<const std::uint32_t> layer;  ///< see-through triangles before them; empty: none
  std::span<const shade::LightFactors> lights;
  std::vector<const std::uint8_t*> masks;  ///< of each light; null: it has none

  LitBits lit(std::size_t pixel) const {
    LitBits bits = 0;
    for (std::size_t i = 0; i < masks.size(); ++i)
      if (masks[i] != nullptr && masks[i][pixel] != 0) bits |= LitBits{1} << i;
    return bits;
  }
  /// Whether something see-through is before a pixel, or colours a light there.
  bool has_glass(std::size_t pixel) const {
    if (!layer.empty() && layer[pixel] != no_triangle) return true;
    return std::any_of(lights.begin(), lights.end(), [&](const shade::LightFactors& light) {
      return !light.tint.factors.empty() && light.tint.coloured[pixel / shade::TintFactors::run] != 0 &&
             light.tint.factors[pixel] != glm::vec3(1.0f);
    });
  }
};

}  // namespace tenebra::render
