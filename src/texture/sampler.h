// The part of a texture that pixels of the screen see, sixteen at a time.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include <tenebra/simd_level.h>
#include "texture/mip_texture.h"

namespace tenebra::texture {

/// Places of samples on a picture, (0,0) its top left corner and (1,1) the opposite one, one value of all
/// samples after another.
struct TexturePlaces {
  static constexpr std::size_t capacity = 64;
  /// Read and written sixteen at a time from any place on.
  static constexpr std::size_t room = capacity + 16;
  using Channel = float[room];

  alignas(64) Channel at[2];             ///< u and v
  alignas(64) Channel by_x[2], by_y[2];  ///< what they change by from this pixel to the next in x and in y
};

/// Red, green, blue and alpha of samples, 0 to 1, linear.
struct TextureValues {
  alignas(64) TexturePlaces::Channel channel[4];
};

constexpr int most_taps = 16;

/// Values of samples `first` ... `first + count - 1`; may write up to fifteen behind them. Of level 0 by
/// `map`'s `magnify` where the picture is enlarged; else by `minify` and `mip` from as many places along the
/// longer axis of the pixel's ellipse as it is longer than the shorter one, at most `most_taps`, each as
/// large as the shorter axis. What `map` says of wrapping and transforms counts no more. Coordinates that are
/// not finite or beyond 1e9 give the first pixel. The same bits for each vector level.
using Sampler = void (*)(const MipTexture& texture, const TextureMap& map, const TexturePlaces& at,
                         std::size_t first, std::size_t count, TextureValues& out);
Sampler sampler(SimdLevel level);

}  // namespace tenebra::texture
