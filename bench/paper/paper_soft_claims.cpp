#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/paper/paper_soft.h"
#include "soft/groups/point_groups.h"

namespace tenebra::bench {
namespace {

constexpr double megabyte_bytes = 1e6;
constexpr double lifetime_queries = 5000;  // fewer do not tell how a tree ends: the paper's has 17,878

struct Range {
  double least = 0, most = 0;
};
template <class Value>
Range range_of(const std::vector<TreeView>& views, const Value& value) {
  Range range{value(views.front()), value(views.front())};
  for (const TreeView& v : views)
    range.least = std::min(range.least, value(v)), range.most = std::max(range.most, value(v));
  return range;
}
/// What a figure of memory is worth where a tree came to its bound; empty where none did.
std::string bound_note(double bytes) {
  return came_to_bound(bytes)
             ? fmt::format("; but some trees came to {} MiB, which makes them alike", tree_bound_mib)
             : std::string();
}
/// Memory decides, unless trees came to their bound.
Verdict verdict_of_memory(bool holds, double most_bytes) {
  return came_to_bound(most_bytes) ? Verdict::not_here : verdict_of(holds);
}
double over(double a, double b) {
  return a / std::max(b, 1.0);
}

void add_quality(const SoftFindings& found, std::vector<Claim>& claims) {
  double worst = 0, rms = 0, equal_time = HUGE_VAL, faster = HUGE_VAL, slower = 0;
  std::size_t wins = 0, races = 0;
  for (const TreeView& v : found.views) {
    if (!v.race) continue;
    ++races;
    const double speed = v.race->over_embree;
    worst = std::max(worst, v.race->max_error_255), rms = std::max(rms, v.race->rmse_255);
    equal_time = std::min(equal_time, v.race->rmse_at_equal_time_255);
    faster = std::min(faster, speed), slower = std::max(slower, speed);
    wins += speed > 1 ? 1 : 0;
  }
  const bool finite = std::all_of(found.views.begin(), found.views.end(),
                                  [](const TreeView& v) { return v.paper.finite && v.neighbourhood.finite; });
  claims.push_back({"mora.robust", "section 6",
                    "The method is robust: it needs no 5D geometry and never fails.", verdict_of(finite),
                    "All fractions and irradiances of all views are numbers, 0 or more."});
  if (races == 0) return;
  claims.push_back({"mora.exact", "section 5.1, Figure 7", "The shadows are exact: they have no noise.",
                    verdict_of(worst <= 0.1),
                    fmt::format("The worst pixel errs by {:.3f}/255 of white (single precision).", worst)});
  claims.push_back({"mora.rays_are_noisy_in_its_time", "Figure 7",
                    "In the same time ray-traced shadows are always noisy.", verdict_of(equal_time > rms),
                    fmt::format("Embree's RMS error in the trees' time: at least {:.2f}/255; theirs: at most "
                                "{:.4f}.",
                                equal_time, rms)});
  claims.push_back(
      {"mora.faster_than_rays", "Figure 7",
       "At comparable quality it is always faster than an optimised ray tracer.", verdict_of(wins == races),
       fmt::format("Embree takes {:.2f} to {:.2f} times the trees' time; the trees are faster on "
                   "{} of {} views. Embree is a later ray tracer than the paper's.",
                   faster, slower, wins, races)});
}

/// Section 5.5 speaks of very few points per triangle: where most points lie on triangles that have fewer
/// than a neighbourhood. What is dropped before it is used again shows in the nodes.
void add_grouping(const SoftFindings& found, std::vector<Claim>& claims) {
  const auto nodes = [](const TreeView& v) { return over(v.paper.nodes, v.neighbourhood.nodes); };
  const auto times = [](const TreeView& v) { return v.paper.ms / std::max(v.neighbourhood.ms, 1e-9); };
  std::size_t small = 0, gain = 0;
  std::string each;
  for (const auto* views : {&found.views, &found.small}) {
    for (const TreeView& v : *views) {
      const bool few = v.points_a_triangle < soft::largest_neighbourhood;
      small += few ? 1 : 0, gain += few && nodes(v) > 1 ? 1 : 0;
      each += fmt::format("{} {}: {:.0f} points, {:.2f} times the nodes, {:.2f} the time",
                          each.empty() ? "" : ";", v.view, v.points_a_triangle, nodes(v), times(v));
    }
  }
  claims.push_back(
      {"mora.neighbourhoods_would_help", "section 5.5",
       "With very few points per triangle efficiency is lost: points should be grouped by neighbourhood.",
       small == 0 ? Verdict::not_here : verdict_of(gain == small),
       fmt::format("Points per triangle (half of all points lie on triangles with no more), and the nodes "
                   "and the time of grouping by triangle over those of groups of 8x8 pixels:{}. {} of {} "
                   "views of fewer than {} points gain.",
                   each, gain, small, soft::largest_neighbourhood)});
}

void add_costs(const SoftFindings& found, std::vector<Claim>& claims) {
  const auto& views = found.views;
  const Range bytes = range_of(views, [](const TreeView& v) { return v.paper.bytes / megabyte_bytes; });
  const bool bounded = came_to_bound(megabyte_bytes * bytes.most);
  claims.push_back(
      {"mora.low_memory", "Figure 8", "The memory of trees is low: 16 to 21 MB with four threads.",
       verdict_of(bytes.most <= 21),
       fmt::format("{:.2f} to {:.2f} MB{}.", bytes.least, bytes.most,
                   bounded ? fmt::format(", where trees reached {} MiB and would have grown", tree_bound_mib)
                           : std::string())});
  const Range queries = range_of(views, [](const TreeView& v) {
    return 100 * v.paper.query_ms / std::max(v.paper.shaft_ms + v.paper.init_ms + v.paper.query_ms, 1e-9);
  });
  claims.push_back({"mora.queries_dominate", "Figure 8", "Queries clearly dominate: 91 to 97 % of the time.",
                    verdict_of(queries.least >= 80),
                    fmt::format("{:.1f} to {:.1f} %.", queries.least, queries.most)});
  const Range nodes = range_of(views, [](const TreeView& v) { return over(v.anew.nodes, v.kept.nodes); });
  const Range times = range_of(views, [](const TreeView& v) { return v.anew.ms / v.kept.ms; });
  claims.push_back({"mora.coherence_pays", "Figure 8", "A tree kept from query to query makes fewer nodes.",
                    verdict_of(nodes.least > 1),
                    fmt::format("With each query starting anew, {:.1f} to {:.1f} times as many.", nodes.least,
                                nodes.most)});
  claims.push_back(
      {"mora.coherence_pays_16_times", "Figure 8",
       "With each query starting anew it is 16 to 48 times slower.", verdict_of(times.least >= 16),
       fmt::format(
           "{:.2f} to {:.2f} times{}.", times.least, times.most,
           bounded ? "; where a kept tree reaches its bound, the rest of its group is clipped" : "")});
  const Range choice =
      range_of(views, [](const TreeView& v) { return over(v.paper.nodes, v.largest.nodes); });
  const Range choice_time =
      range_of(views, [](const TreeView& v) { return v.paper.ms / std::max(v.largest.ms, 1e-9); });
  claims.push_back(
      {"mora.random_is_best", "section 4.3",
       "Heuristics gain too little over a random occluder for what they cost.",
       verdict_of(choice_time.most <= 1.1),
       fmt::format(
           "Random choice makes {:.2f} to {:.2f} times the nodes of the largest occluder first, which is "
           "Tenebra's default, in {:.2f} to {:.2f} times the time.",
           choice.least, choice.most, choice_time.least, choice_time.most)});
  add_grouping(found, claims);
}

void add_growths(const SoftFindings& found, std::vector<Claim>& claims) {
  if (found.areas.size() < 2 || found.lights.size() < 2) return;
  const TreeCost &small = found.areas.front().cost, &large = found.areas.back().cost;
  claims.push_back(
      {"mora.larger_lights_cost_more", "Figure 9",
       "Time and memory grow with the light's area, to 100 times.",
       large.nodes > small.nodes ? verdict_of_memory(large.bytes >= small.bytes, large.bytes)
                                 : Verdict::fails,
       fmt::format("{:.1f} times the nodes, {:.1f} times the time, {:.2f} to {:.2f} MB{}.",
                   over(large.nodes, small.nodes), large.ms / small.ms, small.bytes / megabyte_bytes,
                   large.bytes / megabyte_bytes, bound_note(large.bytes))});
  claims.push_back({"mora.largest_light_is_far_from_critical", "Figure 9",
                    "Even at the largest light memory is far from a problem.",
                    verdict_of(!came_to_bound(large.bytes)),
                    fmt::format("{:.2f} MB, of at most {} MiB per tree{}.", large.bytes / megabyte_bytes,
                                tree_bound_mib, bound_note(large.bytes))});
  claims.push_back({"mora.faster_at_the_largest_light", "section 5.2",
                    "At the largest light 512 samples take 2.33 times as long.", Verdict::not_here,
                    "The scene (Conference) is not here; Figure 7's race is."});
  const GrowthRow &few = found.lights.front(), &many = found.lights.back();
  const double each = (many.cost.nodes / many.count) / std::max(few.cost.nodes / few.count, 1.0);
  claims.push_back(
      {"mora.lights_are_linear", "Figure 10", "Time is linear in the number of lights.",
       verdict_of(each > 0.5 && each < 2),
       fmt::format("A light's nodes at {:g} lights are {:.2f} of those at {:g}, its time {:.2f}.", many.count,
                   each, few.count, (many.cost.ms / many.count) / (few.cost.ms / few.count))});
  claims.push_back(
      {"mora.lights_share_memory", "Figure 10",
       "Memory does not depend on the number of lights, but on how complex one is.",
       verdict_of_memory(many.cost.bytes < 2 * few.cost.bytes, many.cost.bytes),
       fmt::format("{:.2f} MB for {:g} lights, {:.2f} MB for {:g}{}.", few.cost.bytes / megabyte_bytes,
                   few.count, many.cost.bytes / megabyte_bytes, many.count, bound_note(many.cost.bytes))});
  const SplitLight& split = found.split;
  claims.push_back(
      {"mora.huge_lights_can_be_split", "section 5.3",
       "Memory limits oversized lights; a huge one as the union of small ones solves that, without noise.",
       split.difference_255 <= 0.5
           ? verdict_of_memory(split.part_bytes < split.whole_bytes, split.whole_bytes)
           : Verdict::fails,
       fmt::format("Four quarters of the largest: at most {:.3f}/255 off; {:.2f} MB against {:.2f}{}.",
                   split.difference_255, split.part_bytes / megabyte_bytes,
                   split.whole_bytes / megabyte_bytes, bound_note(split.whole_bytes))});
}

void add_life(const SoftFindings& found, std::vector<Claim>& claims) {
  const auto& rows = found.life.rows;
  const char* says =
      "A tree grows quickly at first, then hardly, and queries become cheap (2,896 occluders, 17,878 "
      "queries).";
  if (rows.size() < 3) {
    claims.push_back({"mora.trees_stop_growing", "Figure 11", says, Verdict::not_here,
                      "No tree of this view lives long enough."});
    return;
  }
  const auto first = std::find_if(rows.begin(), rows.end(), [&](const LifeRow& row) {
    return row.queries >= 0.25 * rows.back().queries;
  });
  const double grown = over(first->nodes, rows.back().nodes);
  const std::string bound = found.life.dropped_at > 0
                                ? fmt::format(" It comes to {} MiB soon after query {}.", tree_bound_mib,
                                              counted(found.life.dropped_at))
                                : "";
  claims.push_back(
      {"mora.trees_stop_growing", "Figure 11", says,
       rows.back().queries < lifetime_queries ? Verdict::not_here
                                              : verdict_of(grown > 0.5 && found.life.dropped_at == 0),
       fmt::format("{}The tree with most to do: {} occluders, {} queries: {:.0f} % of {} nodes are there "
                   "after {} of them; {:.0f} us a "
                   "query at first, {:.1f} in the end.{}",
                   rows.back().queries < lifetime_queries ? "Asked too little to tell how it ends. " : "",
                   counted(found.life.occluders), counted(rows.back().queries), 100 * grown,
                   counted(rows.back().nodes), counted(first->queries), rows.front().us_a_query,
                   rows.back().us_a_query, bound)});
}

}  // namespace

std::vector<Claim> soft_claims(const SoftFindings& found) {
  std::vector<Claim> claims;
  if (found.views.empty()) return claims;
  add_quality(found, claims);
  add_costs(found, claims);
  add_growths(found, claims);
  add_life(found, claims);
  claims.push_back({"mora.scales_to_soda_hall", "Figure 7", "Soda Hall, 2.1 million triangles, in 5 s.",
                    Verdict::not_here, "The model is not here."});
  claims.push_back({"mora.seconds", "Figures 7 and 8", "5 to 10 s on an i7 920.", Verdict::not_here,
                    "Another processor and other scenes; ratios are above."});
  return claims;
}

}  // namespace tenebra::bench
