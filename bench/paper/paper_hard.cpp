// The experiments of Olsson and Assarsson 2011: Figure 6 (nodes and time over the animation of the robots),
// Figure 7 (early accept and two passes), Table 2 (views of the museum).
#include <fmt/core.h>

#include <algorithm>

#include "bench/ao/ao_race.h"
#include "bench/common/bench_plot.h"
#include "bench/common/bench_scenes.h"
#include "bench/paper/paper_hard.h"
#include "bench/paper/paper_session.h"
#include "shadow/decision/triangle_planes.h"

namespace tenebra::bench {

const VariantCost& VariantFrame::of(Variant variant) const {
  const auto found = std::find(paper_variants.begin(), paper_variants.end(), variant);
  return costs[static_cast<std::size_t>(found - paper_variants.begin())];
}

namespace {

HardShadowConfig paper_config(Variant variant, bool cull_front) {
  HardShadowConfig config;
  config.variant = variant;
  config.cull_front = cull_front;
  return config;
}

/// Triangles that are tested at the root: not those that face the light, if they are culled.
double root_tests(const HardView& view, bool cull_front) {
  shadow::TriangleSet set;
  shadow::build_triangle_set(view.frame.triangles(), shadow::ray_source(view.light),
                             paper_config(Variant::precise, cull_front), set);
  return static_cast<double>(set.planes.size());
}

VariantCost trace_variant(const HardView& view, const HardShadowConfig& config, double at_root, int rounds,
                          ShadowTracer& tracer, ShadowMask& mask) {
  std::vector<double> times, sorts, traversals;
  for (int i = 0; i < rounds; ++i) {
    CostClock clock;
    tracer.trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, config, mask);
    times.push_back(clock.ms());
    sorts.push_back(tracer.timings().sort_ms);
    traversals.push_back(tracer.timings().traverse_ms);
  }
  return {median(times), median(sorts), median(traversals),
          static_cast<double>(tracer.stats().nodes) - at_root};
}

}  // namespace

VariantFrame measure_variants(int number, const HardView& view, int rounds,
                              std::array<ShadowTracer, 7>& tracers) {
  VariantFrame frame;
  frame.frame = number;
  frame.triangles = root_tests(view, true);
  ShadowMask first, mask;
  for (std::size_t i = 0; i < paper_variants.size(); ++i) {
    frame.costs[i] =
        trace_variant(view, paper_config(paper_variants[i], true), frame.triangles, rounds, tracers[i], mask);
    if (i == 0) first = mask;
    frame.same_masks = frame.same_masks && mask == first;
  }
  frame.rays = static_cast<double>(tracers[0].stats().rays);
  frame.nodes_unculled = trace_variant(view, paper_config(Variant::precise_sorted, false),
                                       root_tests(view, false), 1, tracers[3], mask)
                             .nodes;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    frame.culled_differing += mask[i] != first[i] ? 1 : 0;
    frame.lit_differing += mask[i] < first[i] ? 1 : 0;
  }
  return frame;
}

namespace {

Expected<void> measure_scene(PaperSession& session, const std::string& scene, const std::vector<int>& numbers,
                             int rounds, std::vector<VariantFrame>& frames) {
  std::array<ShadowTracer, 7> tracers;
  std::size_t next = 0;
  const PictureSize size = session.effort == Effort::tiny ? PictureSize{64, 64} : PictureSize{1024, 1024};
  return for_each_view(session.options, {{scene, numbers}}, size, session.skipped,
                       [&](const Scene&, const HardView& view) -> Expected<void> {
                         frames.push_back(measure_variants(numbers[next++], view, rounds, tracers));
                         progress(view.name + ": the seven variants");
                         for (std::size_t i = 0; i < paper_variants.size(); ++i) {
                           const std::string name(variant_name(paper_variants[i]));
                           const VariantCost& cost = frames.back().costs[i];
                           session.report.add({"hard", view.name, name, "", "time", cost.ms, "ms"});
                           session.report.add({"hard", view.name, name, "", "nodes", cost.nodes, ""});
                         }
                         return {};
                       });
}

/// Curves over the frames; nodes that are not positive have no place on a logarithmic axis.
void add_curves(const std::string& figure, const HardFindings& found, const std::vector<Variant>& variants,
                PaperSection& section) {
  std::vector<Curve> nodes, times;
  for (const Variant variant : variants) {
    nodes.push_back({std::string(variant_name(variant)), {}});
    times.push_back(nodes.back());
    for (const VariantFrame& f : found.figures) {
      nodes.back().points.emplace_back(f.frame, f.of(variant).nodes);
      times.back().points.emplace_back(f.frame, f.of(variant).ms);
    }
  }
  const Axis x{"frame of " + found.figures_scene};
  section.plots.emplace_back(
      "hard_figure" + figure + "_nodes",
      curve_plot("Figure " + figure + "(a): node tests below the root", x, {"nodes", true}, nodes));
  section.plots.emplace_back("hard_figure" + figure + "_time",
                             curve_plot("Figure " + figure + "(b): time", x, {"ms", true}, times));
}

Rows summary_table(const std::vector<VariantFrame>& frames) {
  Rows rows{{"variant", "nodes, least", "median", "most", "ms, median", "most"}};
  for (const Variant variant : paper_variants) {
    std::vector<double> nodes, times;
    for (const VariantFrame& f : frames)
      nodes.push_back(f.of(variant).nodes), times.push_back(f.of(variant).ms);
    rows.push_back({std::string(variant_name(variant)),
                    counted(*std::min_element(nodes.begin(), nodes.end())), counted(median(nodes)),
                    counted(*std::max_element(nodes.begin(), nodes.end())),
                    fmt::format("{:.1f}", median(times)),
                    fmt::format("{:.1f}", *std::max_element(times.begin(), times.end()))});
  }
  return rows;
}

Rows table2(const std::vector<VariantFrame>& frames) {
  Rows rows{{"variant"}};
  for (const VariantFrame& f : frames) {
    rows[0].push_back(fmt::format("frame {}: ms", f.frame));
    rows[0].push_back("M nodes");
  }
  for (const Variant variant :
       {Variant::spheres, Variant::spheres_sorted, Variant::precise, Variant::precise_sorted}) {
    rows.push_back({std::string(variant_name(variant))});
    for (const VariantFrame& f : frames) {
      rows.back().push_back(fmt::format("{:.1f}", f.of(variant).ms));
      rows.back().push_back(fmt::format("{:.2f}", f.of(variant).nodes / 1e6));
    }
  }
  return rows;
}

PaperSection hard_section_of(const PaperSession& session, const HardFindings& found) {
  PaperSection section;
  section.title = hard_title;
  section.setup = fmt::format(
      "Pictures of {}, the scene's first light, one ray per pixel. Figures 6 and 7: {} frames of {}. Table "
      "2: {} of {}. All seven variants with front-face culling, as the paper had it; rays start at the exact "
      "points (the paper's from the depth buffer). Nodes are counted below the root, at which every triangle "
      "is tested once in any variant. {}Leaves hold sixteen rays, the paper's one: nodes are those above "
      "them.",
      session.effort == Effort::tiny ? "64x64" : "1024x1024", found.figures.size(), found.figures_scene,
      found.table.size(), found.table_scene,
      found.table_scene == "museum5x64"
          ? "museum5x64 (scenes/make_museum5x64.py) stands in for the museum at its finest, which was not at "
            "hand: as many triangles that move by themselves. "
          : "");
  section.claims = hard_claims(found);
  section.tables = {
      {fmt::format("Figures 6 and 7 over {}", found.figures_scene), summary_table(found.figures)},
      {fmt::format("Table 2, {}", found.table_scene), table2(found.table)}};
  add_curves("6", found,
             {Variant::spheres, Variant::spheres_sorted, Variant::precise, Variant::precise_sorted}, section);
  add_curves("7", found, {Variant::precise_sorted, Variant::precise_sea, Variant::precise_seatp}, section);
  return section;
}

}  // namespace

Expected<void> measure_paper_hard(PaperSession& session) {
  HardFindings found;
  found.figures_scene = session.scene_of({"robots", "city"});
  const int count = found.figures_scene == "robots" ? 800 : 300;
  std::vector<int> numbers = session.frames(count);
  if (count == 800 && std::find(numbers.begin(), numbers.end(), 160) == numbers.end())
    numbers.insert(std::upper_bound(numbers.begin(), numbers.end(), 160), 160);  // which the paper speaks of
  if (auto done =
          measure_scene(session, found.figures_scene, numbers, session.by_effort(1, 1, 3), found.figures);
      !done)
    return done;
  found.table_scene = session.scene_of({"museum5", "gallery"});
  if (found.table_scene == "museum5") found.table_scene = "museum5x64";
  const std::vector<int> views = session.by_effort<std::vector<int>>({20}, {20, 200}, {20, 100, 150, 200});
  if (auto done = measure_scene(session, found.table_scene, views, 1, found.table); !done) return done;
  found.closed = measure_closed_meshes(session.by_effort<PictureSize>({64, 64}, {}, {}));
  session.finish(hard_section_of(session, found));
  return {};
}

}  // namespace tenebra::bench
