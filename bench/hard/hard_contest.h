// Tenebra's default hard shadows and Embree's on one view: timed in turn, so that other load of the machine
// affects both alike.
#pragma once

#include "bench/common/bench_report.h"
#include "bench/hard/hard_views.h"

namespace tenebra::bench {

/// Medians in milliseconds; of one thread processor time.
struct HardTimes {
  double ours_dynamic = 0;    ///< all that moved since the frame before included
  double ours_static = 0;     ///< nothing moved
  double embree_build = 0;    ///< low quality, once more
  double embree_dynamic = 0;  ///< that and its trace
  double embree_static = 0;   ///< the better of the medium and high quality builds, trace alone
  double points = 0;          ///< the visible points in double, which both start from
  double tiled_points = 0;    ///< the same, and the tiles of floats that ours reads
  const char* dynamic_tile = "";
  const char* static_tile = "";
  std::size_t differing = 0;  ///< pixels where Embree's mask differs
  TraceStats stats;           ///< of ours

  double dynamic_ratio() const { return ours_dynamic / embree_dynamic; }
  double static_ratio() const { return ours_static / embree_static; }
  /// What each starts from included; the floats that Embree's packets are loaded from are not.
  double dynamic_ratio_with_points() const {
    return (ours_dynamic + tiled_points) / (embree_dynamic + points);
  }
  double static_ratio_with_points() const { return (ours_static + tiled_points) / (embree_static + points); }
};

struct HardContest {
  int threads = 1;
  int rounds = 9;
  bool dynamic = true;                    ///< else only the static contestants
  SimdLevel simd = SimdLevel::automatic;  ///< of both
};

/// On `threads` threads, at least three rounds.
HardTimes run_hard_contest(const HardView& view, const HardContest& contest);
/// Adds all of `times` to `report`.
void report_times(const HardTimes& times, const std::string& experiment, const std::string& view,
                  const std::string& parameter, Report& report);

}  // namespace tenebra::bench
