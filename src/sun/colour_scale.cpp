#include "sun/colour_scale.h"

#include <algorithm>
#include <array>

namespace tenebra::sun {

glm::vec3 ColourScale::operator()(double value) const {
  // matplotlib's viridis (CC0) at each tenth.
  constexpr std::array<std::uint32_t, 11> tenths{0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c,
                                                 0x22a884, 0x44bf70, 0x7ad151, 0xbddf26, 0xfde725};
  const auto colour = [&](std::size_t i) {
    const std::uint32_t c = tenths[i];
    return glm::vec3(c >> 16, c >> 8 & 255, c & 255) / 255.0f;
  };
  const double at = 10 * std::clamp(value / most, 0.0, 1.0);
  const auto below = std::min(static_cast<std::size_t>(at), std::size_t{9});
  return glm::mix(colour(below), colour(below + 1), static_cast<float>(at - static_cast<double>(below)));
}

ColourScale scale_of(const Study& study) {
  double most = 0;
  for (std::size_t i = 0; i < study.hours.sums.size(); ++i) most = std::max(most, value_of(study, i));
  return {most > 0 ? most : 1};
}

}  // namespace tenebra::sun
