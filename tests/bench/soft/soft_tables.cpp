#include "bench/soft/soft_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

using Table = std::vector<std::vector<std::string>>;

constexpr double megabyte = 1e6;

std::string seconds(double ms) {
  return fmt::format("{:.3f}", ms / 1000);
}
std::string megabytes(double bytes) {
  return fmt::format("{:.2f}", bytes / megabyte);
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

std::string cost_table(const std::vector<CostRow>& costs) {
  Table table{{"view", "trees MB", "shaft %", "init %", "query %", "irradiance %", "total s", "anew/kept"}};
  for (const CostRow& c : costs) {
    table.push_back({c.view, megabytes(c.peak_bytes), percent(c.shaft), percent(c.init), percent(c.query),
                     percent(c.irradiance), seconds(c.total_ms), times(c.fall_off)});
  }
  return "Cost, and the fall-off when every query starts a tree anew, solver bsp (Figure 8)\n" +
         text_table(table);
}

std::string area_table(const std::vector<AreaRow>& areas) {
  Table table{{"view", "Tenebra s", "trees MB", "Embree s", "Embree/Tenebra", "rays"}};
  for (const AreaRow& a : areas) {
    const Contest& c = a.contest;
    table.push_back({c.view, seconds(c.tenebra_ms), megabytes(static_cast<double>(c.stats.peak_tree_bytes)),
                     seconds(c.embree_ms), times(c.over_embree), rays_at_eq(c)});
  }
  return "Growing light (Figure 9)\n" + text_table(table);
}

std::string lights_table(const std::vector<LightsRow>& lights, const std::string& view) {
  Table table{{"lights", "Tenebra s", "s a light", "trees MB"}};
  for (const LightsRow& l : lights) {
    table.push_back({fmt::format("{}", l.lights), seconds(l.time_ms),
                     seconds(l.time_ms / static_cast<double>(std::max<std::size_t>(l.lights, 1))),
                     megabytes(l.peak_bytes)});
  }
  return fmt::format("Many lights, {} (Figure 10)\n{}", view, text_table(table));
}

std::string life_table(const std::vector<LifeRow>& life, const std::string& view) {
  Table table{{"queries", "us a query", "tree MB", "nodes"}};
  for (const LifeRow& l : life) {
    table.push_back({fmt::format("{}", l.queries), times(l.us_a_query), megabytes(l.bytes),
                     fmt::format("{:.0f}", l.nodes)});
  }
  return fmt::format("One tree's life, {} (Figure 11)\n{}", view, text_table(table));
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

void add_cost_plots(const std::vector<CostRow>& costs, Report& report) {
  std::vector<std::string> names;
  Bars shaft{"shaft culling", {}}, init{"init", {}}, query{"query", {}}, irradiance{"irradiance", {}};
  Bars memory{"trees", {}}, fall_off{"anew / kept", {}};
  for (const CostRow& c : costs) {
    names.push_back(c.view);
    shaft.values.push_back(c.shaft * c.total_ms / 1000);
    init.values.push_back(c.init * c.total_ms / 1000);
    query.values.push_back(c.query * c.total_ms / 1000);
    irradiance.values.push_back(c.irradiance * c.total_ms / 1000);
    memory.values.push_back(c.peak_bytes / megabyte);
    fall_off.values.push_back(c.fall_off);
  }
  report.add_plot("figure8_time",
                  bar_plot("Time by stage", {"time (s)"}, names, {shaft, init, query, irradiance}, true));
  report.add_plot("figure8_memory", bar_plot("Most memory of all trees alive", {"MB"}, names, {memory}));
  report.add_plot("figure8_fall_off",
                  bar_plot("Fall-off when every query starts anew", {"factor"}, names, {fall_off}));
}

void add_growth_plots(const SoftResults& results, Report& report) {
  Curve time{"Tenebra", {}}, memory{"trees", {}}, embree{"Embree at equal quality", {}};
  for (const AreaRow& a : results.areas) {
    time.points.emplace_back(a.factor, a.contest.tenebra_ms / 1000);
    embree.points.emplace_back(a.factor, a.contest.embree_ms / 1000);
    memory.points.emplace_back(a.factor, static_cast<double>(a.contest.stats.peak_tree_bytes) / megabyte);
  }
  report.add_plot("figure9_time", curve_plot("Growing light, " + results.growth_view,
                                             {"area (times the smallest)"}, {"time (s)"}, {time, embree}));
  report.add_plot("figure9_memory", curve_plot("Growing light, " + results.growth_view,
                                               {"area (times the smallest)"}, {"MB"}, {memory}));
  Curve lights_time{"Tenebra", {}}, lights_memory{"trees", {}};
  for (const LightsRow& l : results.lights) {
    lights_time.points.emplace_back(static_cast<double>(l.lights), l.time_ms / 1000);
    lights_memory.points.emplace_back(static_cast<double>(l.lights), l.peak_bytes / megabyte);
  }
  Curve cost{"a query", {}}, tree{"the tree", {}};
  for (const LifeRow& l : results.life) {
    cost.points.emplace_back(static_cast<double>(l.queries), l.us_a_query);
    tree.points.emplace_back(static_cast<double>(l.queries), l.bytes / megabyte);
  }
  report.add_plot("figure11_time", curve_plot("One tree's life, " + results.growth_view, {"queries"},
                                              {"time a query (us)"}, {cost}));
  report.add_plot("figure11_memory",
                  curve_plot("One tree's life, " + results.growth_view, {"queries"}, {"MB"}, {tree}));
  report.add_plot("figure10_time",
                  curve_plot("Many lights, " + results.growth_view, {"lights"}, {"time (s)"}, {lights_time}));
  report.add_plot("figure10_memory",
                  curve_plot("Many lights, " + results.growth_view, {"lights"}, {"MB"}, {lights_memory}));
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
  for (const auto* races : {&results.races, &results.sun_races})
    if (!races->empty()) text += error_table(*races) + '\n';
  if (!results.costs.empty()) text += cost_table(results.costs) + '\n';
  if (!results.areas.empty()) text += area_table(results.areas) + '\n';
  if (!results.lights.empty()) text += lights_table(results.lights, results.growth_view) + '\n';
  if (!results.life.empty()) text += life_table(results.life, results.growth_view) + '\n';
  for (const std::string& sentence : results.skipped) text += sentence + '\n';
  return text;
}

void add_soft_plots(const SoftResults& results, Report& report) {
  if (!results.contests.empty()) add_contest_plots(results.contests, report);
  if (!results.costs.empty()) add_cost_plots(results.costs, report);
  if (!results.areas.empty()) add_growth_plots(results, report);
}

std::string soft_summary(const SoftResults& results) {
  std::vector<double> over_embree, over_fair;
  double error = 0, bytes = 0;
  for (const Contest& c : results.contests) {
    error = std::max(error, c.max_error_255);
    bytes = std::max(bytes, static_cast<double>(c.stats.peak_tree_bytes));
    if (!c.counted) continue;
    over_embree.push_back(c.over_embree);
    over_fair.push_back(c.over_fair);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return error_summary(results.races) + sun_summary(results.sun_races) +
         fmt::format(
             "soft.eq_geomean: {:.2f}\nsoft.eq_worst: {:.2f}\nsoft.fair_worst: {:.2f}\nsoft.max_error_255: "
             "{:.4f}\n"
             "soft.peak_tree_mb: {:.2f}\n",
             over_embree.empty() ? nan : geometric_mean(over_embree), worst(over_embree), worst(over_fair),
             results.contests.empty() ? nan : error, results.contests.empty() ? nan : bytes / megabyte);
}

}  // namespace tenebra::bench
