// Hard shadows from a depth cube with a bias: what users would otherwise use, and what its errors are
// compared with.
#pragma once

#include "bench/hard/hard_views.h"
#include "bench/trade/trade_raster.h"

namespace tenebra::bench {

/// A sample is in shadow if what its texel sees is nearer by more than `texels` widths of a texel at the
/// sample, times 1 + the slope of the receiver against the light (at most `steepest`): the customary constant
/// and slope-scaled bias in one number, so that one number is to be tuned.
struct ShadowMapBias {
  double texels = 0;
  static constexpr float steepest = 8;
};

/// 255 lit, 0 shadowed or facing away. On all threads.
void shadow_from_map(const DepthMap& map, const HardView& view, ShadowMapBias bias, ShadowMask& mask);

/// Pixels where the masks differ.
std::size_t differing_pixels(const ShadowMask& a, const ShadowMask& b);

/// Of many biases, none among them, the one with the fewest pixels that differ from `exact`: more than a user
/// can hope for, who has no exact mask and one number for all frames.
ShadowMapBias best_bias(const DepthMap& map, const HardView& view, const ShadowMask& exact);

}  // namespace tenebra::bench
