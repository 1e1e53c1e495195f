// A lightmap on its way: the mean of each texel's samples, and what surrounds the texels that have some.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/sample.h"

namespace tenebra::bake {

/// Red, green and blue: what a white diffuse surface shows, 1 white; alpha: openness.
using Light = glm::vec4;

struct BakedMap {
  int size = 0;
  std::vector<Light> texels;         ///< row 0 at the top, where v is 0
  std::vector<std::uint8_t> filled;  ///< 1: has a value; by samples or by dilate()

  explicit BakedMap(int side = 0)
      : size(side),
        texels(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), Light(0.0f)),
        filled(texels.size(), 0) {}
  std::size_t lit_texels() const;     ///< with a value, and light in it
  std::size_t filled_texels() const;  ///< with a value
};

/// Writes the means of `samples`, whose light is `light`, those of a texel after each other.
void add_means(std::span<const Sample> samples, std::span<const Light> light, BakedMap& map);

/// Gives texels without a value the mean of their neighbours that have one, ring by ring, `rings` times: so
/// that bilinear filtering and smaller copies mix no black in at the borders of what is covered.
void dilate(BakedMap& map, int rings);

}  // namespace tenebra::bake
