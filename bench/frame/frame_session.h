// One run of `tenebra-bench frame`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>

#include "bench/common/bench_session.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct FrameHeadline {
  std::optional<double> ratio_geomean, ratio_worst, unshaded_geomean, unshaded_worst, city_per_second,
      render_over_frames;
};

struct FrameSession : BenchSession {
  using BenchSession::BenchSession;

  FrameHeadline headline;
};

// The parts.
Expected<void> measure_frames(FrameSession& session);       ///< whole frames, against a renderer on Embree
Expected<void> measure_frame_files(FrameSession& session);  ///< the program with pictures and without

}  // namespace tenebra::bench
