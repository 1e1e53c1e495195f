// One run of `tenebra-bench hard`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>

#include "bench/common/bench_session.h"
#include "bench/hard/hard_views.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct HardHeadline {
  std::optional<double> dynamic_geomean, static_geomean, dynamic_worst, static_worst;
  std::optional<double> growth_static_1_8m, p99_over_median;
  std::optional<double> whole_moved_geomean, whole_moved_worst, whole_static_geomean, whole_static_worst;
  std::optional<double> first_moved_geomean, first_moved_worst, first_static_geomean, first_static_worst;
  std::optional<double> sun_geomean, sun_worst;
  std::optional<double> cut_moved_geomean, cut_moved_worst;
};

struct HardSession : BenchSession {
  using BenchSession::BenchSession;

  SimdLevel simd = SimdLevel::automatic;  ///< of both contestants
  HardHeadline headline;

  PictureSize size() const {
    if (effort == Effort::tiny) return {64, 64};
    return {};
  }
};

// The parts.
Expected<void> measure_hard_frames(HardSession& session);  ///< the frames, against Embree
Expected<void> measure_hard_whole(HardSession& session);   ///< from ids to masks, against all that Embree has
Expected<void> measure_hard_sun(HardSession& session);     ///< the same with directional lights
Expected<void> measure_hard_cut(HardSession& session);     ///< as whole, of triangles cut up in place
Expected<void> measure_hard_growth(HardSession& session);  ///< resolution, triangles, copies
Expected<void> measure_hard_variance(HardSession& session);  ///< over a whole animation

}  // namespace tenebra::bench
