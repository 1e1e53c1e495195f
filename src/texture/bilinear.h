// A texture at one place, between its four nearest pixels: what alpha and transmission mean where light
// crosses a surface, and level 0 of what a picture shows.
#pragma once

#include <glm/glm.hpp>

#include <tenebra/material.h>

namespace tenebra::texture {

/// The pixel that stands at index `i` of a row or column of `size` pixels, `i` of any size and sign.
int wrap(std::int64_t i, int size, Wrap mode);

/// The four values of `image` at texture coordinates `uv`, before `map`'s transform, as they are stored,
/// mapped to 0..1: between pixel centres bilinear, whatever the map's filters; (0,0) is the top left corner
/// of the top left pixel. Coordinates that are not finite or beyond 2^31 pixels give the first pixel. Within
/// 4 ulp of the formula.
glm::vec4 sample_bilinear(const TextureImage& image, const TextureMap& map, glm::vec2 uv);

}  // namespace tenebra::texture
