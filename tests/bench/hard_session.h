// One run of `tenebra-bench hard`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench_parts.h"
#include "hard_views.h"

namespace tenebra::bench {

using HardEffort = Effort;

/// The last lines; parts that were left out leave theirs empty.
struct HardHeadline {
  std::optional<double> dynamic_geomean, static_geomean, dynamic_worst, static_worst;
  std::optional<double> growth_static_1_8m, p99_over_median;
};

struct HardSession {
  BenchOptions options;
  HardEffort effort = HardEffort::full;
  SimdLevel simd = SimdLevel::automatic;  ///< of both contestants
  Report report;
  HardHeadline headline;
  std::vector<std::string> notes;    ///< sentences: what was missing, replaced or out of bounds
  std::vector<std::string> skipped;  ///< scenes that are not there

  /// The value for this run's effort.
  template <class T>
  T by_effort(T tiny, T quick, T full) const {
    return effort == HardEffort::tiny ? tiny : effort == HardEffort::quick ? quick : full;
  }
  PictureSize size() const {
    if (effort == HardEffort::tiny) return {64, 64};
    return {};
  }
};

/// Prints at once, for those who watch.
void print_hard_table(const std::string& title, const std::vector<std::vector<std::string>>& rows);

// The parts.
Expected<void> measure_hard_frames(HardSession& session);    ///< the frames, against Embree
Expected<void> measure_hard_growth(HardSession& session);    ///< resolution, triangles, copies
Expected<void> measure_hard_variance(HardSession& session);  ///< over a whole animation
Expected<void> measure_hard_paper(HardSession& session);     ///< Figures 6 and 7, Table 2 of the paper

}  // namespace tenebra::bench
