// The frames of the goals: Tenebra's default against Embree with its build and without.
#include <fmt/core.h>
#include <algorithm>
#include <cstdio>

#include "bench/common/bench_plot.h"
#include "bench/hard/hard_contest.h"
#include "bench/hard/hard_session.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

Rows head() {
  return {{"frame", "triangles", "tenebra", "unmoved", "E. build", "E. dynamic", "tile", "E. static", "tile",
           "points", "tiled", "/dynamic", "/static", "with points", "", "differing"}};
}

void add_row(const HardView& view, const HardTimes& t, Rows& rows) {
  rows.push_back({view.name, fmt::format("{}", t.stats.triangles), fmt::format("{:.2f}", t.ours_dynamic),
                  fmt::format("{:.2f}", t.ours_static), fmt::format("{:.2f}", t.embree_build),
                  fmt::format("{:.2f}", t.embree_dynamic), t.dynamic_tile,
                  fmt::format("{:.2f}", t.embree_static), t.static_tile, fmt::format("{:.2f}", t.points),
                  fmt::format("{:.2f}", t.tiled_points), fmt::format("{:.3f}", t.dynamic_ratio()),
                  fmt::format("{:.3f}", t.static_ratio()),
                  fmt::format("{:.3f}", t.dynamic_ratio_with_points()),
                  fmt::format("{:.3f}", t.static_ratio_with_points()), fmt::format("{}", t.differing)});
}

/// Ratios of the counted frames at one number of threads.
struct Ratios {
  std::vector<double> dynamic, still;
  std::vector<double> dynamic_tiled, still_tiled;  ///< the making of our tiles from the points counted
  std::vector<std::string> names;

  void add(const HardView& view, const HardTimes& times) {
    if (!view.counted) return;
    dynamic.push_back(times.dynamic_ratio());
    still.push_back(times.static_ratio());
    const double tiles = times.tiled_points - times.points;
    dynamic_tiled.push_back((times.ours_dynamic + tiles) / times.embree_dynamic);
    still_tiled.push_back((times.ours_static + tiles) / times.embree_static);
    names.push_back(view.name);
  }
};

void conclude(HardSession& session, const Ratios& ratios) {
  if (ratios.dynamic.empty()) return;
  HardHeadline& h = session.headline;
  h.dynamic_geomean = geometric_mean(ratios.dynamic);
  h.static_geomean = geometric_mean(ratios.still);
  h.dynamic_worst = *std::max_element(ratios.dynamic.begin(), ratios.dynamic.end());
  h.static_worst = *std::max_element(ratios.still.begin(), ratios.still.end());
}

}  // namespace

Expected<void> measure_hard_frames(HardSession& session) {
  const int all = thread_count();
  std::vector<int> threads{all};
  if (all != 1) threads.push_back(1);
  std::vector<Rows> tables(threads.size(), head());
  std::vector<Ratios> ratios(threads.size());
  const int rounds = session.by_effort(1, 9, 25);
  const auto measure = [&](const Scene&, const HardView& view) -> Expected<void> {
    for (std::size_t i = 0; i < threads.size(); ++i) {
      const HardTimes times = run_hard_contest(view, {threads[i], rounds, true, session.simd});
      report_times(times, "frames", view.name, fmt::format("threads={}", threads[i]), session.report);
      add_row(view, times, tables[i]);
      ratios[i].add(view, times);
      progress(fmt::format("{}, {} threads: {:.3f} of Embree dynamic, {:.3f} of static", view.name,
                           threads[i], times.dynamic_ratio(), times.static_ratio()));
    }
    return {};
  };
  const auto frames = hard_frames(session.effort != Effort::full);
  if (auto done = for_each_view(session.options, frames, session.size(), session.skipped, measure); !done)
    return done;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    print_table(fmt::format("Frames, {} thread{}: medians in ms{}", threads[i], threads[i] == 1 ? "" : "s",
                            threads[i] == 1 ? " of processor time" : ""),
                tables[i]);
    if (ratios[i].dynamic.empty()) continue;
    std::printf("geometric means of the frames of BART: %.3f of Embree dynamic, %.3f of Embree static\n",
                geometric_mean(ratios[i].dynamic), geometric_mean(ratios[i].still));
    std::printf(
        "neither counts making what it reads: Embree planes of floats, Tenebra tiles of floats, made with "
        "the points (\"tiled\": both). With the time to make the tiles: %.3f, %.3f\n",
        geometric_mean(ratios[i].dynamic_tiled), geometric_mean(ratios[i].still_tiled));
    session.report.add_plot(
        fmt::format("frames_{}", threads[i]),
        bar_plot(fmt::format("Time in units of Embree's, {} threads", threads[i]), {"ratio"}, ratios[i].names,
                 {{"of build and trace", ratios[i].dynamic}, {"of trace", ratios[i].still}}));
  }
  conclude(session, ratios.front());
  return {};
}

}  // namespace tenebra::bench
