// One run of `tenebra-bench picture`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/common/bench_parts.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct PictureHeadline {
  std::optional<double> rms_4, rms_16, cost_4, cost_16, missed_percent, flicker_16;
};

struct PictureSession {
  BenchOptions options;
  Effort effort = Effort::full;
  Report report;
  PictureHeadline headline;
  std::vector<std::string> skipped;  ///< what could not be measured, each with its reason

  /// The value for this run's effort.
  template <class T>
  T by_effort(T tiny, T quick, T full) const {
    return effort == Effort::tiny ? tiny : effort == Effort::quick ? quick : full;
  }
};

// The parts.
Expected<void> measure_picture_views(PictureSession& session);    ///< errors and costs of single frames
Expected<void> measure_picture_flicker(PictureSession& session);  ///< consecutive frames

}  // namespace tenebra::bench
