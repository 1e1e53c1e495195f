#include "bench/soft/soft_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

using Table = std::vector<std::vector<std::string>>;

std::string seconds(double ms) {
  return fmt::format("{:.3f}", ms / 1000);
}
std::string times(double factor) {
  return fmt::format("{:.2f}", factor);
}
std::string percent(double share) {
  return fmt::format("{:.1f}", 100 * share);
}
std::string rays_at_eq(const Contest& c) {
  return fmt::format("{}{}", c.eq_rays, c.eq_reached ? "" : " (not reached)");
}

std::string contest_table(const std::vector<Contest>& contests) {
  Table table{{"view", "triangles", "Tenebra s", "Embree s", "shaft+Embree s", "Embree/Tenebra",
               "shaft+Embree/Tenebra", "error/255", "rays"}};
  for (const Contest& c : contests) {
    table.push_back({c.view, fmt::format("{}", c.triangles), seconds(c.tenebra_ms), seconds(c.embree_ms),
                     seconds(c.fair_ms), times(c.over_embree), times(c.over_fair),
                     fmt::format("{:.4f}", c.max_error_255), rays_at_eq(c)});
  }
  return fmt::format(
      "Equal quality: Embree's stratified rays per pixel with a penumbra RMSE under {}/255 (Figure 7)\n{}",
      equal_quality_255, text_table(table));
}

std::string equal_time_table(const std::vector<Contest>& contests) {
  Table table{{"view", "time s", "Tenebra RMSE/255", "Embree RMSE/255", "points left by the shafts %"}};
  for (const Contest& c : contests) {
    table.push_back({c.view, seconds(c.tenebra_ms), fmt::format("{:.4f}", c.rmse_255),
                     fmt::format("{:.2f}", c.rmse_at_equal_time_255), percent(c.traced_part)});
  }
  return "Equal time (Figure 7)\n" + text_table(table);
}

std::string tree_table(const std::vector<TreeRow>& trees) {
  Table table{{"view", "s", "of the default", "trees MB", "clipped %"}};
  for (const TreeRow& row : trees) {
    const TreeCost& c = row.cost;
    table.push_back({row.view, seconds(c.ms), times(c.ms / row.default_ms),
                     fmt::format("{:.2f}", c.bytes / 1e6),
                     fmt::format("{:.1f}", 100 * c.clipped / std::max(c.clipped + c.by_tree, 1.0))});
  }
  return "Solver bsp; tenebra-bench paper says more about it\n" + text_table(table);
}

void add_contest_plots(const std::vector<Contest>& contests, Report& report) {
  std::vector<std::string> names;
  Bars tenebra{"Tenebra", {}}, fair{"shaft culling + Embree", {}}, embree{"Embree", {}};
  std::vector<Curve> curves;
  for (const Contest& c : contests) {
    names.push_back(c.view);
    tenebra.values.push_back(c.tenebra_ms / 1000);
    fair.values.push_back(c.fair_ms / 1000);
    embree.values.push_back(c.embree_ms / 1000);
    Curve curve{"Embree, " + c.view, {}};
    for (const SampledPoint& p : c.curve) curve.points.emplace_back(p.time_ms / c.tenebra_ms, p.rmse_255);
    curves.push_back(std::move(curve));
  }
  report.add_plot("figure7_equal_quality",
                  bar_plot("Time at equal quality", {"time (s)", true}, names, {tenebra, fair, embree}));
  report.add_plot("figure7_convergence",
                  curve_plot("Embree's error over its time", {"time / Tenebra's time", true},
                             {"penumbra RMSE (1/255 of white)", true}, curves));
}

double worst(const std::vector<double>& speed_ups) {
  return speed_ups.empty() ? std::numeric_limits<double>::quiet_NaN()
                           : *std::min_element(speed_ups.begin(), speed_ups.end());
}

}  // namespace

std::string soft_tables(const SoftResults& results) {
  std::string text;
  if (!results.contests.empty())
    text += contest_table(results.contests) + '\n' + equal_time_table(results.contests) + '\n';
  if (!results.trees.empty()) text += tree_table(results.trees) + '\n';
  for (const auto* races : {&results.races, &results.sized_races, &results.sun_races})
    if (!races->empty()) text += error_table(*races) + '\n';
  if (!results.large.empty()) text += large_table(results.large) + '\n';
  if (!results.grown.empty()) text += grown_table(results.grown) + '\n';
  for (const std::string& sentence : results.skipped) text += sentence + '\n';
  return text;
}

void add_soft_plots(const SoftResults& results, Report& report) {
  if (!results.contests.empty()) add_contest_plots(results.contests, report);
}

std::string soft_summary(const SoftResults& results) {
  std::vector<double> over_embree, over_fair;
  double error = 0, bytes = 0;
  for (const Contest& c : results.contests) {
    error = std::max(error, c.max_error_255);
    if (!c.counted) continue;
    over_embree.push_back(c.over_embree);
    over_fair.push_back(c.over_fair);
  }
  for (const TreeRow& row : results.trees) bytes = std::max(bytes, row.cost.bytes);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return error_summary(results.races) + sized_summary(results.sized_races) + sun_summary(results.sun_races) +
         large_summary(results.large, results.grown) +
         headline("soft.eq_geomean", over_embree.empty() ? nan : geometric_mean(over_embree), 2) +
         headline("soft.eq_worst", worst(over_embree), 2) + headline("soft.fair_worst", worst(over_fair), 2) +
         headline("soft.max_error_255", results.contests.empty() ? nan : error, 4) +
         headline("soft.peak_tree_mb", results.trees.empty() ? nan : bytes / 1e6, 2);
}

}  // namespace tenebra::bench
