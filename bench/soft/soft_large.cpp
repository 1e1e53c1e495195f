#include "bench/soft/soft_large.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "bench/soft/soft_quality.h"

namespace tenebra::bench {
namespace {

constexpr double grown_percent = 10;  ///< the smallest has 1

double time_mask(const SoftView& view, double error, SoftMask& mask, SoftStats& stats) {
  SoftShadowTracer tracer;
  SoftShadowConfig config;
  config.error_255 = error;
  base::Stopwatch watch;
  tracer.trace(view.frame.points, view.frame.normals, view.frame.triangles(), view.light, config, mask);
  const double ms = watch.lap_ms();
  stats = tracer.stats();
  return ms;
}

bool all_numbers(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value) && value >= 0; });
}

std::string in_seconds(double ms) {
  return fmt::format("{:.2f}", ms / 1000);
}

}  // namespace

LargeRow measure_large(const SoftView& view, Report& report) {
  progress(fmt::format("{}: exact, and at {}/255", view.name, large_error_255));
  LargeRow row{view.name, 0, 0, 0, 0, true};
  SoftMask mask;
  SoftStats stats;
  Truth truth;
  row.exact_ms = time_mask(view, 0, truth.mask, stats);
  row.finite = all_numbers(truth.mask.irradiance) && all_numbers(truth.mask.visible_fraction);
  finish_truth(view.frame, view.light, truth);
  row.error_ms = time_mask(view, large_error_255, mask, stats);
  row.rmse = penumbra_rmse_255(truth, mask.irradiance);
  row.estimate = stats.error_255;
  const std::string what = fmt::format("error={}", large_error_255);
  report.add({"large", view.name, "tenebra", "error=0", "time", row.exact_ms, "ms"});
  report.add({"large", view.name, "tenebra", what, "time", row.error_ms, "ms"});
  report.add({"large", view.name, "tenebra", what, "rmse", row.rmse, "1/255"});
  report.add({"large", view.name, "tenebra", what, "estimate", row.estimate, "1/255"});
  return row;
}

Expected<GrownLight> measure_grown(const SoftView& view, int rounds, Report& report) {
  SoftView grown = view;
  auto light = square_light(view.frame, grown_percent);
  if (!light) return tl::unexpected(light.error());
  grown.light = std::move(*light);
  grown.name += fmt::format(", {} %", grown_percent);
  ContestPlan plan;
  plan.experiment = "figure9";
  plan.truth = testing::SoftPrecision::fast;
  plan.rounds = rounds;
  plan.whole_curve = false;
  GrownLight out;
  out.exact = run_contest(grown, plan, report);
  plan.config.error_255 = equal_quality_255;
  out.by_error = run_contest(grown, plan, report);
  return out;
}

std::string large_table(const std::vector<LargeRow>& rows) {
  Rows table{{"view", "exact s", fmt::format("at {} s", large_error_255), "error", "estimate", "finite"}};
  for (const LargeRow& row : rows)
    table.push_back({row.view, in_seconds(row.exact_ms), in_seconds(row.error_ms),
                     fmt::format("{:.2f}", row.rmse), fmt::format("{:.2f}", row.estimate),
                     row.finite ? "yes" : "no"});
  return "Lights of half the diagonal (errors in 1/255)\n" + text_table(table);
}

std::string grown_table(const std::vector<GrownLight>& grown) {
  Rows table{{"view", "Tenebra", "s", "RMSE/255", "Embree s", "rays", "Embree/Tenebra"}};
  for (const GrownLight& g : grown) {
    const auto add = [&](const char* how, const Contest& c) {
      table.push_back({c.view, how, in_seconds(c.tenebra_ms), fmt::format("{:.3f}", c.rmse_255),
                       in_seconds(c.embree_ms),
                       fmt::format("{}{}", c.eq_rays, c.eq_reached ? "" : " (not reached)"),
                       fmt::format("{:.2f}", c.over_embree)});
    };
    add("exact", g.exact);
    add("at 0.5/255", g.by_error);
  }
  return "100 times the area of the smallest light, at equal quality (Figure 9)\n" + text_table(table);
}

std::string large_summary(const std::vector<LargeRow>& rows, const std::vector<GrownLight>& grown) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double error_ms = rows.empty() ? nan : 0.0, exact_ms = error_ms;
  for (const LargeRow& row : rows) {
    error_ms = std::max(error_ms, row.error_ms);
    exact_ms = std::max(exact_ms, row.finite ? row.exact_ms : std::numeric_limits<double>::infinity());
  }
  std::vector<double> gains, exact_gains;
  for (const GrownLight& g : grown)
    gains.push_back(g.by_error.over_embree), exact_gains.push_back(g.exact.over_embree);
  return headline("soft.large_s", error_ms / 1000, 2) + headline("soft.large_exact_s", exact_ms / 1000, 1) +
         headline("soft.large_gain", gains.empty() ? nan : geometric_mean(gains), 2) +
         headline("soft.large_gain_exact", exact_gains.empty() ? nan : geometric_mean(exact_gains), 2);
}

}  // namespace tenebra::bench
