// What sampled pixels have seen of the light so far.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/hard_config.h>
#include "soft/sample/sampled_blocks.h"

namespace tenebra::soft {

/// Sums over places on the light, in two halves, so that their difference tells how far off they are. Weights
/// are cos cos / r^2 times the square of the distance to the light's origin.
struct LightTally {
  static constexpr std::size_t halves = 2;
  struct Half {
    std::vector<float> weight_seen, weight;  ///< one for each slot: of the visible places, of all
    std::vector<float> weight_square;        ///< sum of the squares, of all
    std::vector<float> seen, places;         ///< their numbers; places below a horizon do not count
  };
  Half half[halves];
  /// How unevenly a slot's places weigh: the variance of their weighted mean over that of as many with equal
  /// weights, at least 1. Near the light few of them count.
  float unevenness(std::size_t slot) const;
  std::vector<std::uint32_t> rays;  ///< of each block: places that each of its slots has looked at

  void start(const SampledBlocks& blocks);
  /// Adds a place on the light, `place` relative to the light's origin in units of its size. `mask`: of
  /// take_phase(chosen, phase), 255 where it is visible.
  void add(const SoftFrame& frame, const SampledBlocks& blocks, std::span<const std::uint32_t> chosen,
           std::uint32_t phase, std::size_t half, const glm::vec3& place, const ShadowMask& mask);
};

}  // namespace tenebra::soft
