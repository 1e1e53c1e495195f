// Summary of a list of measurements: how long a frame usually takes, and how long the slow ones take.
#pragma once

#include <cstddef>
#include <span>

namespace tenebra::base {

struct Summary {
  std::size_t count = 0;
  double median = 0;  ///< mean of the two middle values for even counts
  double percentile_95 =
      0;  ///< nearest rank: the smallest value with at least 95 % of the values at or below it
  double percentile_99 = 0;
  double worst = 0;
  std::size_t worst_at = 0;  ///< index of the first worst value
};

/// All zero for no values. Values are finite.
Summary summarize(std::span<const double> values);

}  // namespace tenebra::base
