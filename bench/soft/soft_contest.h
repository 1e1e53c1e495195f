// The contest on one view: Tenebra, Embree's stratified shadow rays, and shaft culling + Embree, at equal
// quality and at equal time (Mora et al. 2012, section 5.1, Figure 7).
#pragma once

#include <optional>
#include <vector>

#include "bench/common/bench_report.h"
#include "bench/soft/soft_fair.h"
#include "bench/soft/soft_views.h"
#include "support/soft_precision.h"

namespace tenebra::bench {

inline constexpr std::size_t most_rays = 512;     ///< if too few for equal quality, their time counts
inline constexpr double equal_quality_255 = 0.5;  ///< RMSE over the penumbra, in 1/255 of white

struct ContestPlan {
  std::string experiment = "figure7";                                ///< as the report calls it
  SoftShadowConfig config{};                                         ///< of Tenebra's side
  testing::SoftPrecision truth = testing::SoftPrecision::reference;  ///< what errors are measured against
  int rounds = 5;           ///< timed runs of each contestant, in turn
  bool whole_curve = true;  ///< all powers of two up to most_rays, not only up to EQ
  bool pictures = false;    ///< keep the irradiance at equal time
};

/// What a number of rays per pixel gives and costs.
struct SampledPoint {
  std::size_t rays = 0;
  double rmse_255 = 0;
  double time_ms = 0;
};

struct Contest {
  std::string view;
  bool counted = false;
  std::size_t triangles = 0;
  double tenebra_ms = 0;   ///< medians of the rounds
  double embree_ms = 0;    ///< at eq_rays
  double fair_ms = 0;      ///< at eq_rays
  double over_embree = 0;  ///< embree / tenebra, median of the rounds' ratios
  double over_fair = 0;
  std::size_t eq_rays = most_rays;
  bool eq_reached = false;
  double fair_rmse_255 = 0;           ///< of shaft + Embree at eq_rays
  double traced_part = 0;             ///< of the points, that the shafts left to Embree
  double max_error_255 = 0;           ///< of Tenebra, against the exact answer
  double rmse_255 = 0;                ///< of Tenebra, over the penumbra
  double rmse_at_equal_time_255 = 0;  ///< of Embree in Tenebra's time, between two powers of two
  Packing packing = Packing::tile;
  std::vector<SampledPoint> curve;  ///< ascending rays
  SoftStats stats;
  FrameTimings timings;                  ///< of Tenebra's last run: shares of shaft, init, query, irradiance
  std::vector<float> tenebra;            ///< irradiance
  std::vector<float> embree_equal_time;  ///< with the fewest rays that take at least as long; pictures only
  SampledPoint equal_time;               ///< what that took
  double white = 1;
  std::vector<std::uint8_t> penumbra;  ///< one per pixel, 1: sees a part of the light
};

/// Runs the contest and adds every measurement to `report`.
Contest run_contest(const SoftView& view, const ContestPlan& plan, Report& report);

}  // namespace tenebra::bench
