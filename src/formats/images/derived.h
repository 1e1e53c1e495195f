// Pictures that formats state in other ways than Material wants them.
#pragma once

#include <tenebra/material.h>

namespace tenebra::formats {

/// Whether a bump map holds heights, that is shades of grey; else it holds normals, as many files have it.
bool holds_heights(const TextureImage& bumps);

/// Normals of a surface that is `height` pixels higher where `heights` is white than where it is black, by
/// central differences; as Material::normal_map. The picture repeats.
TextureImage normals_of_heights(const TextureImage& heights, double height);

/// The colours of `colors` with the brightness of `shares` as alpha, or its alpha if it has any. As wide and
/// high as the larger of both in each direction; the nearest pixels count.
TextureImage with_alpha(const TextureImage& colors, const TextureImage& shares);

/// The brightness of `roughness` in green and that of `metallic` in blue, as
/// Material::metallic_roughness_map. Sizes are treated as with_alpha() does.
TextureImage metallic_roughness(const TextureImage& roughness, const TextureImage& metallic);

/// Whether alpha says yes or no: all but an eighth of the pixels are nearly 0 or nearly 255.
bool cuts_out(const TextureImage& image);

}  // namespace tenebra::formats
