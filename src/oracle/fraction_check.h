// Checks computed visible fractions of an area light against the exact answers at some samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "oracle/exact_soft.h"

namespace tenebra::oracle {

/// The fractions to check, and the error that they promise.
struct FractionRequest {
  const ExactSoft* front = nullptr;
  const ExactSoft* back = nullptr;  ///< the polygon's other side, where it shines too
  double promise = 0;               ///< largest error of a fraction; 2^-48 of distance over size come on top
  std::size_t most_occluders = 1'000;  ///< samples with more are skipped: time grows with their square
};

struct FractionStats {
  std::uint64_t samples = 0;   ///< with an answer
  std::uint64_t penumbra = 0;  ///< of these, those that see a part of the light
  std::uint64_t skipped =
      0;  ///< beside them: too many occluders, or in the light's own plane but for roundings
  std::uint64_t occluders = 0;  ///< of all samples together
  double largest_error = 0;

  FractionStats& operator+=(const FractionStats& other);
};

struct WrongFraction {
  std::size_t pixel = 0;
  std::uint32_t triangle = 0;  ///< that the sample lies on
  double said = 0, exact = 0;
};

struct FractionCheck {
  FractionStats stats;
  static constexpr std::size_t most_named = 1000;
  std::uint64_t wrong_count = 0;
  std::vector<WrongFraction> wrong;  ///< the first `most_named`, in the order of `pixels`
};

/// Asks about each of `pixels` of `fractions`, on all cores. `points`: with positions. With `stop` requested
/// it ends early; `stats` says how far it came.
FractionCheck check_fractions(const FractionRequest& request, const VisiblePoints& points,
                              std::span<const float> fractions, std::span<const std::size_t> pixels,
                              const StopFlag* stop = nullptr);

}  // namespace tenebra::oracle
