// One run of `tenebra-bench picture`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>

#include "bench/common/bench_session.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct PictureHeadline {
  std::optional<double> rms_4, rms_16, cost_4, cost_16, missed_percent, flicker_16;
};

constexpr int sample_counts[] = {1, 4, 16};  ///< samples per pixel that are compared

struct PictureSession : BenchSession {
  using BenchSession::BenchSession;

  PictureHeadline headline;
};

// The parts.
Expected<void> measure_picture_views(PictureSession& session);    ///< errors and costs of single frames
Expected<void> measure_picture_flicker(PictureSession& session);  ///< consecutive frames

}  // namespace tenebra::bench
