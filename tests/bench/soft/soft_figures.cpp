#include "bench/soft/soft_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"

namespace tenebra::bench {
namespace {

constexpr double smallest_side_percent = 1;
constexpr std::size_t group_side = 8;   // pixels of a neighbourhood's side
constexpr std::size_t grid_side = 6;    // lights of Figure 10's grid
constexpr float grid_step_percent = 2;  // of the diagonal, between centres

/// The points of one of `every` tiles; the rest sees nothing.
VisiblePoints some_tiles(const VisiblePoints& points, std::size_t every) {
  VisiblePoints some = points;
  const auto width = static_cast<std::size_t>(points.width);
  const std::size_t columns = (width + group_side - 1) / group_side;
  for (std::size_t i = 0; i < some.triangles.size(); ++i) {
    const std::size_t tile = i / width / group_side * columns + i % width / group_side;
    if (tile * 2654435761u % 4294967296u * every / 4294967296u != 0) some.triangles[i] = no_triangle;
  }
  return some;
}

double trace_ms(const SoftView& view, const VisiblePoints& points, const SoftShadowConfig& config,
                SoftShadowTracer& tracer) {
  SoftMask mask;
  base::Stopwatch watch;
  tracer.trace(points, view.frame.normals, view.frame.view, view.frame.triangles(), view.light, config, mask);
  return watch.lap_ms();
}

void measure_fall_off(const SoftView& view, std::size_t every, CostRow& row) {
  const VisiblePoints points = some_tiles(view.frame.points, every);
  SoftShadowTracer tracer;
  SoftShadowConfig config;
  config.solver = SoftSolver::bsp;
  trace_ms(view, points, config, tracer);  // warm
  row.bsp_ms = trace_ms(view, points, config, tracer);
  config.keep_trees = false;
  row.anew_ms = trace_ms(view, points, config, tracer);
  row.fall_off = row.anew_ms / row.bsp_ms;
}

}  // namespace

CostRow measure_cost(const SoftView& view, const Contest& contest, std::size_t every, Report& report) {
  progress(fmt::format("{}: each query anew, on one of {} tiles", view.name, every));
  const FrameTimings& t = contest.timings;
  const double stages = t.shaft_ms + t.init_ms + t.query_ms + t.irradiance_ms;
  const double scale = stages > 0 ? 1 / stages : 0;
  CostRow row{view.name};
  row.peak_bytes = static_cast<double>(contest.stats.peak_tree_bytes);
  row.shaft = t.shaft_ms * scale, row.init = t.init_ms * scale;
  row.query = t.query_ms * scale, row.irradiance = t.irradiance_ms * scale;
  row.total_ms = contest.tenebra_ms;
  measure_fall_off(view, every, row);
  const auto note = [&](const std::string& parameter, const std::string& quantity, double value,
                        const char* unit) {
    report.add({"figure8", view.name, "tenebra", parameter, quantity, value, unit});
  };
  note("", "time", row.total_ms, "ms");
  note("", "peak tree memory", row.peak_bytes, "bytes");
  note("", "shaft share", row.shaft, "");
  note("", "init share", row.init, "");
  note("", "query share", row.query, "");
  note("", "irradiance share", row.irradiance, "");
  const SoftStats& s = contest.stats;
  note("", "groups", static_cast<double>(s.groups), "");
  note("", "points lit", static_cast<double>(s.points_lit), "");
  note("", "points dark", static_cast<double>(s.points_dark), "");
  note("", "points penumbra", static_cast<double>(s.points_penumbra), "");
  note("", "candidates", static_cast<double>(s.candidates), "");
  note("", "points by bsp", static_cast<double>(s.points_bsp), "");
  note("", "points by clip", static_cast<double>(s.points_clip), "");
  note("", "points by silhouettes", static_cast<double>(s.points_silhouette), "");
  note("", "fragments", static_cast<double>(s.fragments), "");
  note("", "tree nodes", static_cast<double>(s.tree_nodes), "");
  const std::string tiles = fmt::format("solver=bsp tiles=1/{}", every);
  note(tiles, "time", row.bsp_ms, "ms");
  note(tiles + " anew", "time", row.anew_ms, "ms");
  note(tiles, "fall-off", row.fall_off, "");
  return row;
}

std::vector<AreaRow> measure_areas(const SoftView& view, const std::vector<double>& factors, int rounds,
                                   Report& report) {
  std::vector<AreaRow> rows;
  for (const double factor : factors) {
    const auto light = square_light(view.frame, smallest_side_percent * std::sqrt(factor));
    if (!light) continue;  // cannot happen: squares of 1 to 10 % are lights wherever one of 4 % is
    SoftView grown = view;
    grown.light = *light;
    grown.name = fmt::format("{} area x{:g}", view.name, factor);
    ContestPlan plan;
    plan.experiment = "figure9";
    plan.truth = SoftPrecision::fast;  // within 0.1/255: EQ is five times that
    plan.rounds = rounds;
    plan.whole_curve = false;
    rows.push_back({factor, run_contest(grown, plan, report)});
    report.add({"figure9", view.name, "tenebra", fmt::format("area={:g}", factor), "peak tree memory",
                static_cast<double>(rows.back().contest.stats.peak_tree_bytes), "bytes"});
  }
  return rows;
}

std::vector<LightsRow> measure_lights(const SoftView& view, const std::vector<std::size_t>& counts,
                                      Report& report) {
  std::vector<AreaLight> lights;
  const float step_m = 0.01f * grid_step_percent * view.frame.diagonal_m;
  for (std::size_t i = 0; i < grid_side * grid_side; ++i) {
    const float x = static_cast<float>(i % grid_side) - 0.5f * (grid_side - 1);
    const float z = static_cast<float>(i / grid_side) - 0.5f * (grid_side - 1);
    const auto light = square_light(view.frame, smallest_side_percent, step_m * glm::vec3(x, 0, z));
    if (light) lights.push_back(*light);
  }
  SoftShadowTracer tracer;
  SoftView one = view;
  std::vector<LightsRow> rows;
  for (const std::size_t count : counts) {
    progress(fmt::format("{}: {} lights", view.name, count));
    LightsRow row{std::min(count, lights.size())};
    for (std::size_t i = 0; i < row.lights; ++i) {
      one.light = lights[i * lights.size() / row.lights];  // spread over the grid
      row.time_ms += trace_ms(one, view.frame.points, {}, tracer);
      row.peak_bytes = std::max(row.peak_bytes, static_cast<double>(tracer.stats().peak_tree_bytes));
    }
    const std::string parameter = fmt::format("lights={}", row.lights);
    report.add({"figure10", view.name, "tenebra", parameter, "time", row.time_ms, "ms"});
    report.add({"figure10", view.name, "tenebra", parameter, "peak tree memory", row.peak_bytes, "bytes"});
    rows.push_back(row);
  }
  return rows;
}

}  // namespace tenebra::bench
