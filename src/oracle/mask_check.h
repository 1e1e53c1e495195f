// Checks a computed mask against the exact answers at some of its samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include "oracle/exact_mask.h"

namespace tenebra::oracle {

/// A sample at which the mask differs from real arithmetic.
struct WrongSample {
  std::size_t pixel = 0;
  std::uint32_t triangle = 0;  ///< that the sample lies on
  std::uint8_t said = 0;       ///< by the mask
  ExactAnswer exact;
};

struct MaskCheck {
  ExactMaskStats stats;
  static constexpr std::size_t most_named = 1000;
  std::uint64_t wrong_count = 0;
  std::vector<WrongSample> wrong;  ///< the first `most_named`, in the order of `pixels`
};

/// Asks about each of `pixels` of `mask`, on all cores. `points`: with positions; pixels without a triangle
/// have to be 0 and count as no sample. With `stop` requested it ends early; `stats` says how far it came.
MaskCheck check_mask(const ExactShadow& exact, const VisiblePoints& points,
                     std::span<const std::uint8_t> mask, std::span<const std::size_t> pixels,
                     const StopFlag* stop = nullptr);

/// `count` of the pixels that see a triangle, in their order, spread evenly: one of each stretch of equal
/// length, where within follows from `seed`. All of them if they are no more.
std::vector<std::size_t> spread_samples(std::span<const std::uint32_t> ids, std::size_t count,
                                        std::uint64_t seed);

}  // namespace tenebra::oracle
