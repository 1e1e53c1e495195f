#include "render/light_tints.h"

namespace tenebra::render {

void LightTint::begin(std::size_t pixels) {
  constexpr std::size_t run = shade::TintFactors::run;
  if (factors_.size() != pixels) {
    factors_.assign(pixels, glm::vec3(1.0f));
    coloured_.assign((pixels + run - 1) / run, 0);
    set_.clear();
  }
  for (const std::uint32_t pixel : set_) {
    factors_[pixel] = glm::vec3(1.0f);
    coloured_[pixel / run] = 0;
  }
  set_.clear();
}

void LightTint::set(const TintMask& mask) {
  set_ = mask.pixels;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    factors_[mask.pixels[i]] = mask.factors[i];
    coloured_[mask.pixels[i] / shade::TintFactors::run] = 1;
  }
}

}  // namespace tenebra::render
