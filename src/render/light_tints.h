// The tints of a frame's lights, one factor for each pixel, as shading reads them: white where none is.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/tint.h>
#include "shade/light_terms.h"

namespace tenebra::render {

/// Kept from frame to frame: only what was coloured is made white again.
class LightTint {
public:
  void begin(std::size_t pixels);
  void set(const TintMask& mask);
  shade::TintFactors factors() const { return {factors_, coloured_}; }

private:
  std::vector<glm::vec3> factors_;
  std::vector<std::uint8_t> coloured_;
  std::vector<std::uint32_t> set_;  ///< pixels that are not white
};

}  // namespace tenebra::render
