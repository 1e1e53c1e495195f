// One pixel's look at a texture, through the code that samples sixteen at a time.
#pragma once

#include <cmath>

#include "texture/sampler.h"

namespace tenebra {

/// The pixel's footprint: what coordinates, before TextureMap::transform, change by from this pixel to the
/// next in x and in y.
struct Footprint {
  glm::vec2 dx{0.0f}, dy{0.0f};
};

inline glm::vec4 sample_one(const texture::MipTexture& texture, const TextureMap& map, const glm::vec2& uv,
                            const Footprint& footprint) {
  const glm::dmat3x2 transform(map.transform);
  // Less whole periods, in double, as shading does before coordinates become floats.
  const auto near_zero = [](double x, Wrap wrap) {
    return wrap == Wrap::clamp_to_edge ? x : x - 2 * std::floor(x / 2);
  };
  const glm::dvec2 placed = transform * glm::dvec3(uv, 1.0);
  const glm::vec2 at(near_zero(placed.x, texture.wrap_u()), near_zero(placed.y, texture.wrap_v())),
      by_x = transform * glm::dvec3(footprint.dx, 0.0), by_y = transform * glm::dvec3(footprint.dy, 0.0);
  texture::TexturePlaces places{};
  for (int c = 0; c < 2; ++c) {
    places.at[c][0] = at[c];
    places.by_x[c][0] = by_x[c];
    places.by_y[c][0] = by_y[c];
  }
  texture::TextureValues values;
  texture::sampler(SimdLevel::automatic)(texture, map, places, 0, 1, values);
  return {values.channel[0][0], values.channel[1][0], values.channel[2][0], values.channel[3][0]};
}

}  // namespace tenebra
