#include "render/mask_colour.h"

#include <cmath>

namespace tenebra::render {

base::ImageF mask_colour(const LightMask& mask) {
  base::ImageF out{mask.mask.width, mask.mask.height, 3, {}};
  out.pixels.reserve(3 * mask.mask.pixels.size());
  for (std::size_t i = 0; i < mask.mask.pixels.size(); ++i) {
    const float lit = mask.visible_fraction.pixels.empty() ? static_cast<float>(mask.mask.pixels[i]) / 255.0f
                                                           : mask.visible_fraction.pixels[i];
    out.pixels.insert(out.pixels.end(), 3, lit);
  }
  for (std::size_t i = 0; i < mask.tint.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels[3 * mask.tint.pixels[i] + c] *= mask.tint.factors[i][static_cast<int>(c)];
  return out;
}

base::Image8 mask_colour8(const LightMask& mask) {
  const base::ImageF values = mask_colour(mask);
  base::Image8 out{values.width, values.height, 3, {}};
  out.pixels.reserve(values.pixels.size());
  for (const float value : values.pixels)
    out.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
  return out;
}

}  // namespace tenebra::render
