#include "render/mask_colour.h"

#include <cmath>

namespace tenebra::render {

float visible_fraction(const LightMask& mask, std::size_t pixel) {
  if (!mask.visible_fraction.pixels.empty()) return mask.visible_fraction.pixels[pixel];
  return mask.mask.pixels[pixel] != 0 ? 1.0f : 0.0f;
}

std::uint8_t in_levels(float fraction) {
  return static_cast<std::uint8_t>(std::lround(255.0f * fraction));
}

io::Image8 in_levels(const io::ImageF& fractions) {
  io::Image8 out{fractions.width, fractions.height, fractions.channels, {}};
  out.pixels.reserve(fractions.pixels.size());
  for (const float fraction : fractions.pixels) out.pixels.push_back(in_levels(fraction));
  return out;
}

io::ImageF mask_colour(const LightMask& mask) {
  io::ImageF out{mask.mask.width, mask.mask.height, 3, {}};
  out.pixels.reserve(3 * mask.mask.pixels.size());
  for (std::size_t i = 0; i < mask.mask.pixels.size(); ++i)
    out.pixels.insert(out.pixels.end(), 3, visible_fraction(mask, i));
  for (std::size_t i = 0; i < mask.tint.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels[3 * mask.tint.pixels[i] + c] *= mask.tint.factors[i][static_cast<int>(c)];
  return out;
}

io::Image8 mask_colour8(const LightMask& mask) {
  return in_levels(mask_colour(mask));
}

}  // namespace tenebra::render
