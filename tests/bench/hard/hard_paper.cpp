// The experiments of Olsson and Assarsson 2011 on our tracer: Figure 6 (nodes and time over the animation of
// the robots), Figure 7 (early accept and two passes), Table 2 (views of the museum), with Tiles beside them.
#include <fmt/core.h>
#include <array>

#include "bench/ao/ao_race.h"
#include "bench/common/bench_plot.h"
#include "bench/hard/hard_session.h"

namespace tenebra::bench {
namespace {

struct Cost {
  double ms = 0;
  double nodes = 0;
};

/// Median of `rounds` calls, and the counts, which do not jitter.
Cost cost_of(const HardView& view, Variant variant, int rounds, ShadowTracer& tracer) {
  HardShadowConfig config;
  config.variant = variant;
  ShadowMask mask;
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    CostClock clock;
    tracer.trace_shadow_mask(view.frame.points, view.frame.view, view.frame.triangles(), view.light, config,
                             mask);
    times.push_back(clock.ms());
  }
  return {median(times), static_cast<double>(tracer.stats().nodes)};
}

void add(Report& report, const char* experiment, const std::string& view, Variant variant, const Cost& cost) {
  const std::string name(variant_name(variant));
  report.add({experiment, view, name, "", "time", cost.ms, "ms"});
  report.add({experiment, view, name, "", "nodes", cost.nodes, ""});
}

/// Calls `body` on the frames of one scene.
Expected<void> on_frames(HardSession& session, const std::string& scene, const std::vector<int>& frames,
                         const std::function<void(int, const HardView&)>& body) {
  std::size_t next = 0;
  return for_each_view(session.options, {{scene, frames}}, session.size(), session.skipped,
                       [&](const Scene&, const HardView& view) -> Expected<void> {
                         body(frames[next++], view);
                         progress(view.name + ": the paper's variants");
                         return {};
                       });
}

/// Curves of one figure over the frames of the robots.
struct Figure6 {
  std::vector<Variant> variants;
  std::vector<Curve> ms, nodes;
  std::vector<ShadowTracer> tracers;

  explicit Figure6(std::vector<Variant> v) : variants(std::move(v)), tracers(variants.size()) {
    for (const Variant variant : variants) {
      ms.push_back({std::string(variant_name(variant)), {}});
      nodes.push_back({std::string(variant_name(variant)), {}});
    }
  }
  void measure(const char* experiment, int frame, const HardView& view, int rounds, Report& report) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const Cost cost = cost_of(view, variants[i], rounds, tracers[i]);
      ms[i].points.emplace_back(frame, cost.ms);
      nodes[i].points.emplace_back(frame, cost.nodes);
      add(report, experiment, view.name, variants[i], cost);
    }
  }
  Rows rows() const {
    Rows table{{"variant", "median ms", "median nodes"}};
    for (std::size_t i = 0; i < variants.size(); ++i) {
      std::vector<double> times, counts;
      for (const auto& [frame, value] : ms[i].points) times.push_back(value);
      for (const auto& [frame, value] : nodes[i].points) counts.push_back(value);
      table.push_back(
          {ms[i].name, fmt::format("{:.1f}", median(times)), fmt::format("{:.2f} M", median(counts) / 1e6)});
    }
    return table;
  }
};

Expected<void> measure_robots(HardSession& session) {
  Figure6 figure6(
      {Variant::tiles, Variant::precise_sorted, Variant::spheres_sorted, Variant::precise, Variant::spheres});
  Figure6 figure7({Variant::tiles, Variant::precise_sorted, Variant::precise_sea, Variant::precise_eatp,
                   Variant::precise_seatp});
  std::vector<int> frames;
  for (int f = 0; f < 800; f += session.by_effort(400, 160, 20)) frames.push_back(f);
  const int rounds = session.by_effort(1, 1, 3);
  auto done = on_frames(session, "robots", frames, [&](int frame, const HardView& view) {
    figure6.measure("figure6", frame, view, rounds, session.report);
    figure7.measure("figure7", frame, view, rounds, session.report);
  });
  if (!done || figure6.ms[0].points.empty()) return done;
  const Axis x{"frame of robots"}, time{"time (ms)", true}, nodes{"node tests", true};
  session.report.add_plot("figure6_time", curve_plot("Figure 6: time", x, time, figure6.ms));
  session.report.add_plot("figure6_nodes", curve_plot("Figure 6: node tests", x, nodes, figure6.nodes));
  session.report.add_plot("figure7_time",
                          curve_plot("Figure 7: early accept, two passes", x, time, figure7.ms));
  session.report.add_plot("figure7_nodes", curve_plot("Figure 7: node tests", x, nodes, figure7.nodes));
  print_table("Figure 6: spheres and precise cones, sorted and not, over the robots", figure6.rows());
  print_table("Figure 7: early accept and two passes over the robots", figure7.rows());
  return {};
}

Expected<void> measure_museum(HardSession& session) {
  constexpr std::array variants{Variant::tiles, Variant::precise_sorted, Variant::spheres_sorted,
                                Variant::precise, Variant::spheres};
  Rows table{{"museum5x64", "Tiles", "PreciseSorted", "SpheresSorted", "Precise", "Spheres"}};
  const std::vector<int> frames =
      session.effort == Effort::full ? std::vector<int>{20, 100, 200} : std::vector<int>{20};
  const auto done = on_frames(session, "museum5x64", frames, [&](int frame, const HardView& view) {
    std::vector<std::string> times{fmt::format("{} ms", frame)}, nodes{fmt::format("{} M nodes", frame)};
    for (const Variant variant : variants) {
      ShadowTracer tracer;
      const Cost cost = cost_of(view, variant, 1, tracer);
      add(session.report, "table2", view.name, variant, cost);
      times.push_back(fmt::format("{:.1f}", cost.ms));
      nodes.push_back(fmt::format("{:.2f}", cost.nodes / 1e6));
    }
    table.push_back(times), table.push_back(nodes);
  });
  if (done && table.size() > 1) print_table("Table 2: views of the museum", table);
  return done;
}

}  // namespace

Expected<void> measure_hard_paper(HardSession& session) {
  if (auto done = measure_robots(session); !done) return done;
  return measure_museum(session);
}

}  // namespace tenebra::bench
