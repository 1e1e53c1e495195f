// From the tally of sampled pixels to the values that they show: means with their neighbours on the same
// surface, as far as these do not blur what the pixels see themselves, and estimates of their errors.
#pragma once

#include <cstdint>
#include <vector>

#include "soft/sample/light_tally.h"

namespace tenebra::soft {

/// A slot's own tally, in two halves.
struct OwnAnswer {
  float irradiance[2], fraction;
  float mean() const { return 0.5f * (irradiance[0] + irradiance[1]); }
  float apart() const { return irradiance[0] - irradiance[1]; }
};

/// One for each slot.
struct LightMeans {
  std::vector<float> irradiance;  ///< 0..1: over what it would be with nothing in the way
  std::vector<float> fraction;    ///< 0..1: visible part, over the part above the horizon
  std::vector<float> square;      ///< estimated mean square of the error of `irradiance`

  std::vector<OwnAnswer> own;       ///< on the way to the above: of each slot alone,
  std::vector<float> smooth;        ///< and its mean with its neighbours
  std::vector<float> smooth_apart;  ///< how far the mean's halves are apart; -1 where it lacks a neighbour
};
/// Finds the means of all slots with a pixel. Of a slot's neighbours those count that are seen next to it and
/// lie on one surface with it. `square` is statistical: what no place has seen is not in it.
void find_means(const SoftFrame& frame, const SampledBlocks& blocks, const LightTally& tally,
                LightMeans& out);

}  // namespace tenebra::soft
