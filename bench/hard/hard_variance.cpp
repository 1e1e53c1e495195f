// How steady the shadow pass is: its time over the whole animation of the robots, each frame after the one
// before.
#include <fmt/core.h>
#include <algorithm>

#include "base/statistics.h"
#include "bench/ao/ao_race.h"
#include "bench/common/bench_plot.h"
#include "bench/hard/hard_session.h"

namespace tenebra::bench {
namespace {

constexpr int animation_frames = 800;
constexpr int passes = 3;  // a frame's time is the least of these: what else runs slows the others

}  // namespace

Expected<void> measure_hard_variance(HardSession& session) {
  std::vector<int> frames;
  for (int f = 0; f < animation_frames; f += session.by_effort(400, 8, 1)) frames.push_back(f);
  std::vector<double> times;
  Curve curve{"Tiles", {}};
  ShadowTracer tracer;
  ShadowMask mask;
  const auto trace = [&](const HardView& view, const TriangleView& triangles) {
    CostClock clock;
    tracer.trace_shadow_mask(view.frame.points, triangles, view.light, {.simd = session.simd}, mask);
    return clock.ms();
  };
  const auto measure = [&](const Scene&, const HardView& view) -> Expected<void> {
    double least = 0;
    for (int i = 0; i < passes; ++i) {
      trace(view, triangle_view(view.before));
      const double ms = trace(view, view.frame.triangles());
      least = i == 0 ? ms : std::min(least, ms);
    }
    curve.points.emplace_back(frames[times.size()], least);
    times.push_back(least);
    session.report.add({"variance", view.name, "tenebra", "", "time", least, "ms"});
    if (times.size() % 50 == 0) progress(fmt::format("{}: {:.2f} ms", view.name, least));
    return {};
  };
  auto done = for_each_view(session.options, {{"robots", frames}}, session.size(), session.skipped, measure);
  if (!done || times.empty()) return done;
  const base::Summary summary = base::summarize(times);
  session.headline.p99_over_median = summary.percentile_99 / summary.median;
  print_table(fmt::format("Steadiness over {} frames of the robots", times.size()),
              {{"median ms", "95 %", "99 %", "worst", "99 % / median"},
               {fmt::format("{:.2f}", summary.median), fmt::format("{:.2f}", summary.percentile_95),
                fmt::format("{:.2f}", summary.percentile_99), fmt::format("{:.2f}", summary.worst),
                fmt::format("{:.2f}", *session.headline.p99_over_median)}});
  session.report.add_plot("variance",
                          curve_plot("The shadow pass over the robots", {"frame"}, {"time (ms)"}, {curve}));
  return {};
}

}  // namespace tenebra::bench
