#include "render/light_tints.h"

#include <algorithm>

namespace tenebra::render {

constexpr std::size_t run = shade::TintFactors::run;

void LightTint::begin(std::size_t samples) {
  mask.pixels.clear();
  mask.factors.clear();
  if (factors_.size() != samples) {
    factors_.assign(samples, glm::vec3(1.0f));
    coloured_.assign((samples + run - 1) / run, 0);
  }
  for (std::size_t i = 0; i < coloured_.size(); ++i) {
    if (coloured_[i] == 0) continue;
    coloured_[i] = 0;
    std::fill_n(factors_.begin() + static_cast<std::ptrdiff_t>(i * run), std::min(run, samples - i * run),
                glm::vec3(1.0f));
  }
}

void LightTint::spread() {
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    factors_[mask.pixels[i]] = mask.factors[i];
    coloured_[mask.pixels[i] / run] = 1;
  }
}

}  // namespace tenebra::render
