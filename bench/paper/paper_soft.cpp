// The experiments of Mora et al. 2012: Figures 7 and 8 (quality, cost, coherence), 9 and 10 (growing and many
// lights), 11 (one tree's life).
#include <fmt/core.h>

#include <algorithm>

#include "bench/common/bench_plot.h"
#include "bench/paper/paper_session.h"
#include "bench/paper/paper_soft.h"

namespace tenebra::bench {
namespace {

constexpr double mb = 1e6;
constexpr int paper_width = 1280, paper_height = 720;
constexpr int small_width = 128, small_height = 72;

Expected<void> measure_soft_view(PaperSession& session, const SoftView& view, SoftFindings& found) {
  progress(view.name + ": the paper's trees");
  TreeView trees = measure_trees(view, session.by_effort<std::size_t>(4, 16, 16));
  progress(view.name + ": the paper's trees against rays");
  ContestPlan plan;
  plan.config = mora_config();
  plan.rounds = 1;
  plan.whole_curve = false;
  if (session.effort != Effort::full) plan.truth = testing::SoftPrecision::fast;
  trees.race = run_contest(view, plan, session.report);
  found.views.push_back(std::move(trees));
  if (!found.growth_view.empty() || !(view.name.starts_with("museum5") || view.name.starts_with("court")))
    return {};
  found.growth_view = view.name;
  progress(view.name + ": growing light, many lights");
  using Factors = std::vector<double>;
  using Counts = std::vector<std::size_t>;
  found.areas =
      grow_light(view, session.by_effort<Factors>({1, 100}, {1, 9, 25, 100}, {1, 4, 9, 16, 25, 49, 100}));
  found.lights = add_lights(view, session.by_effort<Counts>({2, 36}, {2, 12, 36}, {2, 4, 9, 12, 16, 24, 36}));
  found.split = split_light(view);
  return {};
}

/// Figure 11, at the paper's size of picture: a tree's life is told by how often it is asked.
Expected<void> measure_life_of(PaperSession& session, const std::string& scene, SoftFindings& found) {
  ViewChoice choice;
  choice.only = {scene};
  if (session.effort == Effort::tiny) choice.width = 64, choice.height = 36;
  return for_each_view(session.options, choice, session.skipped, [&](const SoftView& view) -> Expected<void> {
    if (!found.life_view.empty()) return {};
    progress(view.name + ": one tree's life");
    found.life_view = fmt::format("{}, {}x{}", view.name, choice.width, choice.height);
    found.life = measure_life(view, session.by_effort<std::size_t>(4, 16, 24));
    return {};
  });
}

Rows cost_rows(const SoftFindings& found) {
  Rows rows{{"view", "triangles", "s", "trees MB", "shaft %", "init %", "queries %", "clipped %",
             "anew/kept, nodes", "time", "random/largest, nodes", "triangle/8x8, nodes"}};
  for (const TreeView& v : found.views) {
    const TreeCost& c = v.paper;
    const double stages = std::max(c.shaft_ms + c.init_ms + c.query_ms, 1e-9);
    const auto share = [&](double part) { return fmt::format("{:.1f}", 100 * part / stages); };
    const auto over = [](double a, double b) { return fmt::format("{:.2f}", a / std::max(b, 1e-9)); };
    rows.push_back(
        {v.view, counted(v.triangles), fmt::format("{:.2f}", c.ms / 1000),
         fmt::format("{:.2f}", c.bytes / mb), share(c.shaft_ms), share(c.init_ms), share(c.query_ms),
         fmt::format("{:.1f}", 100 * c.clipped / std::max(c.clipped + c.by_tree, 1.0)),
         over(v.anew.nodes, std::max(v.kept.nodes, 1.0)), over(v.anew.ms, v.kept.ms),
         over(c.nodes, std::max(v.largest.nodes, 1.0)), over(c.nodes, std::max(v.neighbourhood.nodes, 1.0))});
  }
  return rows;
}

Rows race_rows(const SoftFindings& found) {
  Rows rows{{"view", "trees s", "Embree s", "rays", "RMSE of trees", "of Embree in their time",
             "worst error of trees"}};
  for (const TreeView& v : found.views) {
    if (!v.race) continue;
    const Contest& c = *v.race;
    rows.push_back({v.view, fmt::format("{:.2f}", c.tenebra_ms / 1000),
                    fmt::format("{:.2f}", c.embree_ms / 1000),
                    fmt::format("{}{}", c.eq_rays, c.eq_reached ? "" : " (not reached)"),
                    fmt::format("{:.4f}", c.rmse_255), fmt::format("{:.2f}", c.rmse_at_equal_time_255),
                    fmt::format("{:.4f}", c.max_error_255)});
  }
  return rows;
}

void add_growth(const std::string& name, const std::string& title, const char* x,
                const std::vector<GrowthRow>& growth, PaperSection& section) {
  Curve time{"seconds", {}}, memory{"MB", {}};
  for (const GrowthRow& row : growth) {
    time.points.emplace_back(row.count, row.cost.ms / 1000);
    memory.points.emplace_back(row.count, row.cost.bytes / mb);
  }
  section.plots.emplace_back(name + "_time", curve_plot(title, {x}, {"time (s)"}, {time}));
  section.plots.emplace_back(name + "_memory", curve_plot(title, {x}, {"trees (MB)"}, {memory}));
}

void add_soft_plots_of(const SoftFindings& found, PaperSection& section) {
  std::vector<std::string> names;
  Bars memory{"trees", {}}, trees{"trees", {}}, rays{"Embree, equal quality", {}};
  Bars kept{"kept", {}}, anew{"anew", {}};
  for (const TreeView& v : found.views) {
    names.push_back(v.view);
    memory.values.push_back(v.paper.bytes / mb);
    kept.values.push_back(v.kept.nodes / 1e6), anew.values.push_back(v.anew.nodes / 1e6);
    trees.values.push_back(v.race ? v.race->tenebra_ms / 1000 : 0);
    rays.values.push_back(v.race ? v.race->embree_ms / 1000 : 0);
  }
  section.plots.emplace_back(
      "soft_figure7", bar_plot("Figure 7: time at equal quality", {"time (s)", true}, names, {trees, rays}));
  section.plots.emplace_back("soft_figure8", bar_plot("Figure 8: memory", {"trees (MB)"}, names, {memory}));
  section.plots.emplace_back(
      "soft_figure8_coherence",
      bar_plot("Figure 8: nodes, trees kept and anew", {"million nodes", true}, names, {kept, anew}));
  if (found.growth_view.empty()) return;
  add_growth("soft_figure9", "Figure 9: growing light, " + found.growth_view, "area (times the smallest)",
             found.areas, section);
  add_growth("soft_figure10", "Figure 10: many lights, " + found.growth_view, "lights", found.lights,
             section);
  Curve cost{"a query", {}}, tree{"the tree", {}};
  for (const LifeRow& row : found.life.rows) {
    cost.points.emplace_back(row.queries, row.us_a_query);
    tree.points.emplace_back(row.queries, row.bytes / mb);
  }
  section.plots.emplace_back("soft_figure11_time",
                             curve_plot("Figure 11: one tree's life, " + found.life_view, {"queries"},
                                        {"us a query", true}, {cost}));
  section.plots.emplace_back(
      "soft_figure11_memory",
      curve_plot("Figure 11: one tree's life, " + found.life_view, {"queries"}, {"tree (MB)"}, {tree}));
}

PaperSection soft_section_of(const ViewChoice& choice, const SoftFindings& found) {
  PaperSection section;
  section.title = soft_title;
  section.setup = fmt::format(
      "The paper's method: one BSP for each visible triangle, queried for its points in turn, with a random "
      "occluder merged into each leaf that is not known yet (solver `bsp`). Pictures of {}x{}{}, "
      "lights of 4 % of the scene's diagonal, the court its own. T-Rex, Sponza with Neptune, "
      "Conference, Soda Hall and Bike are not here: BART's scenes and the court take their place. A tree "
      "that comes to {} MiB (Tenebra's own: to 4) is dropped, and the rest of its points are clipped instead "
      "(`clipped`); the paper has no bound. Embree's rays are stratified, its tree is built before; equal "
      "quality: RMS error over the penumbra below {}/255. Errors in 1/255 of white.",
      choice.width, choice.height, choice.width == paper_width ? "" : " (the paper's: 1280x720)",
      tree_bound_mib, equal_quality_255);
  section.claims = soft_claims(found);
  section.tables = {{"Figure 7", race_rows(found)},
                    {"Figure 8: cost, and what coherence and order are worth", cost_rows(found)}};
  add_soft_plots_of(found, section);
  return section;
}

}  // namespace

Expected<void> measure_paper_soft(PaperSession& session) {
  SoftFindings found;
  ViewChoice choice;
  choice.only = {"robots", "museum5", "kitchen", "court"};
  if (session.effort == Effort::tiny) choice.only = {"court"};
  choice.width = session.by_effort(64, small_width, paper_width);
  choice.height = session.by_effort(36, small_height, paper_height);
  if (auto done =
          for_each_view(session.options, choice, session.skipped,
                        [&](const SoftView& view) { return measure_soft_view(session, view, found); });
      !done)
    return done;
  if (session.effort == Effort::full) {  // where triangles have fewer points
    ViewChoice small = choice;
    std::vector<std::string> known_to_be_missing;
    small.width = small_width, small.height = small_height;
    if (auto done = for_each_view(session.options, small, known_to_be_missing,
                                  [&](const SoftView& view) -> Expected<void> {
                                    progress(view.name + ": groups in a small picture");
                                    found.small.push_back(measure_grouping(view));
                                    found.small.back().view +=
                                        fmt::format(" at {}x{}", small.width, small.height);
                                    return {};
                                  });
        !done)
      return done;
  }
  if (!found.growth_view.empty()) {
    const std::string scene = found.growth_view.substr(0, found.growth_view.find(' '));
    if (auto done = measure_life_of(session, scene, found); !done) return done;
  }
  session.finish(soft_section_of(choice, found));
  return {};
}

}  // namespace tenebra::bench
