// Tenebra with the errors that users accept beside the best sampler that a rival would write, at equal error.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/common/bench_report.h"
#include "bench/soft/soft_views.h"

namespace tenebra::bench {

inline constexpr std::array<double, 5> raced_errors{8, 4, 2, 1, 0.5};  ///< 1/255, RMS over the penumbra

/// Tenebra at an error that it was asked for, and the rival where it errs as much.
struct ErrorRow {
  double asked = 0;
  double tenebra_ms = 0, rival_ms = 0;  ///< medians
  double rmse = 0, estimate = 0;        ///< of Tenebra, 1/255
  double worst = 0;                     ///< of its pixels, 1/255
  double rays = 0;                      ///< of a sampled pixel, mean
  double sampled = 0;                   ///< of all pixels, 0..1
  bool reached = true;  ///< false: the rival erred by more with its most rays, whose time counts
  double ratio() const { return tenebra_ms / rival_ms; }
  double estimate_off() const;  ///< the larger of truth and estimate over the smaller, both at least 0.25
};

struct ErrorRace {
  std::string view;
  double percent = 0;  ///< of the diagonal: the light's side; 0: the view's own light
  double exact_ms = 0;
  std::array<ErrorRow, raced_errors.size()> rows;
};

/// The rival's error is measured with 4 to `most_rays` rays, with no filter, one pass and two; between two
/// numbers of rays its time is interpolated in the logarithms. Where Tenebra errs by more than it was asked
/// for, the rival may err as much.
ErrorRace race_errors(const SoftView& view, int rounds, std::size_t most_rays, Report& report);

/// For readers, and the lines that a script reads ("soft.ratio_8_geomean: 0.8").
std::string error_table(const std::vector<ErrorRace>& races);
std::string error_summary(const std::vector<ErrorRace>& races);
/// Of lights of other sizes, by size, the worst view: "soft.size_10_ratio_05_worst: 0.9" and so on.
std::string sized_summary(const std::vector<ErrorRace>& races);
/// Of suns, at the least of the errors: the geometric mean of the ratios.
std::string sun_summary(const std::vector<ErrorRace>& races);

}  // namespace tenebra::bench
