// One run of `tenebra-bench frame`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/common/bench_parts.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct FrameHeadline {
  std::optional<double> ratio_geomean, ratio_worst, unshaded_geomean, unshaded_worst, city_per_second,
      render_over_frames;
};

struct FrameSession {
  BenchOptions options;
  Effort effort = Effort::full;
  Report report;
  FrameHeadline headline;
  std::vector<std::string> skipped;  ///< what could not be measured, each with its reason

  /// The value for this run's effort.
  template <class T>
  T by_effort(T tiny, T quick, T full) const {
    return effort == Effort::tiny ? tiny : effort == Effort::quick ? quick : full;
  }
};

// The parts.
Expected<void> measure_frames(FrameSession& session);       ///< whole frames, against a renderer on Embree
Expected<void> measure_frame_files(FrameSession& session);  ///< the program with pictures and without

}  // namespace tenebra::bench
