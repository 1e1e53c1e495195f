#include "stage/default_light.h"

#include <cmath>
#include <numbers>

namespace tenebra::stage {

io::ImageF soft_sky() {
  constexpr int width = 8, height = 64;
  // The mean of sine of height s over the hemisphere, weighted by it, is the integral of 2 s s: 2/3.
  constexpr float zenith = default_horizon + 1.5f * (default_ambient - default_horizon);
  io::ImageF sky{width, height, 3, {}};
  for (int row = 0; row < height; ++row) {
    const auto sine = static_cast<float>(std::cos(std::numbers::pi * (row + 0.5) / height));
    const float radiance = default_horizon + (zenith - default_horizon) * std::max(sine, 0.0f);
    sky.pixels.insert(sky.pixels.end(), std::size_t{3} * width, radiance);
  }
  return sky;
}

}  // namespace tenebra::stage
