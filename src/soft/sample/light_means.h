// From the tally of sampled pixels to the values that they show: means with their neighbours on the same
// surface, as far as these do not blur what the pixels see themselves, and estimates of their errors.
#pragma once

#include <cstdint>
#include <vector>

#include "soft/sample/light_tally.h"

namespace tenebra::soft {

/// One for each slot.
struct LightMeans {
  std::vector<float> irradiance;  ///< 0..1: over what it would be with nothing in the way
  std::vector<float> fraction;    ///< 0..1: visible part, over the part above the horizon
  std::vector<float> square;      ///< estimated mean square of the error of `irradiance`
};
/// Of all slots with a pixel; those of a slot's neighbours count that are seen next to it and lie on one
/// surface with it. `square` is statistical: it does not know what no place has seen.
void find_means(const SoftFrame& frame, const SampledBlocks& blocks, const LightTally& tally,
                LightMeans& out);

}  // namespace tenebra::soft
