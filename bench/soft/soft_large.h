// Large lights: what half the scene's diagonal costs, and the gain over rays when a light grows (Mora et al.
// 2012, Figure 9).
#pragma once

#include <string>
#include <vector>

#include "bench/common/bench_report.h"
#include "bench/soft/soft_contest.h"
#include "bench/soft/soft_views.h"

namespace tenebra::bench {

/// A light of half the diagonal, exactly and at an error.
struct LargeRow {
  std::string view;
  double exact_ms = 0, error_ms = 0;  ///< each the first frame of a tracer: buffers are made, too
  double rmse = 0, estimate = 0;      ///< at large_error_255, 1/255
  bool finite = true;                 ///< all exact values are numbers, 0 or more
};
inline constexpr double large_error_255 = 1;
LargeRow measure_large(const SoftView& view, Report& report);

/// A square of 10 % of the diagonal, 100 times the area of the smallest: Embree at equal quality (0.5/255)
/// over Tenebra, exactly and at that error.
struct GrownLight {
  Contest exact, by_error;
};
Expected<GrownLight> measure_grown(const SoftView& view, int rounds, Report& report);

std::string large_table(const std::vector<LargeRow>& rows);
std::string grown_table(const std::vector<GrownLight>& grown);
/// "soft.large_s", "soft.large_exact_s" (the slowest view), "soft.large_gain" (at the error) and
/// "soft.large_gain_exact".
std::string large_summary(const std::vector<LargeRow>& rows, const std::vector<GrownLight>& grown);

}  // namespace tenebra::bench
