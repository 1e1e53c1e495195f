// The tint of a light at samples: as the tracer lists it, and as shading reads it, one factor for each
// sample.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/tint.h>
#include "shade/light_terms.h"

namespace tenebra::render {

/// Kept from frame to frame: only what was coloured is made white again.
struct LightTint {
  TintMask mask;  ///< the samples that are not white

  /// Makes all of this many samples white.
  void begin(std::size_t samples);
  /// Colours those of `mask`.
  void spread();
  shade::TintFactors factors() const { return {factors_, coloured_}; }

private:
  std::vector<glm::vec3> factors_;
  std::vector<std::uint8_t> coloured_;  ///< as TintFactors has it
};

}  // namespace tenebra::render
