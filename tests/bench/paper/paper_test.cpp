// The papers' claims that counts decide, on small pictures of the bundled scenes, and the committed page.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bench/common/bench_scenes.h"
#include "bench/paper/paper_ao.h"
#include "bench/paper/paper_hard.h"
#include "bench/paper/paper_session.h"
#include "bench/paper/paper_soft.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {

void PrintTo(Verdict verdict, std::ostream* out) {
  *out << verdict_text(verdict);
}

namespace {

Verdict verdict(const std::vector<Claim>& claims, const std::string& id) {
  const Claim* claim = find_claim(claims, id);
  EXPECT_NE(claim, nullptr) << id;
  return claim == nullptr ? Verdict::not_here : claim->verdict;
}

std::string page_text() {
  return testing::read_text(std::filesystem::path(TENEBRA_SCENES_DIR) / ".." / "docs" / "papers.md");
}

/// The committed page has a row with a verdict for each of these claims; of which views, the page says.
void expect_rows(const std::vector<Claim>& claims) {
  const std::string page = page_text();
  for (const Claim& claim : claims) {
    const std::string row = "| " + claim.where + " | " + claim.says + " | **";
    const std::size_t at = page.find(row);
    ASSERT_NE(at, std::string::npos) << claim.id << " has no row: " << row;
    const std::string rest = page.substr(at + row.size(), 24);
    EXPECT_TRUE(rest.starts_with("true**") || rest.starts_with("false**") ||
                rest.starts_with("not testable here**"))
        << claim.id << ": " << rest;
  }
}

void expect_all_hold(const std::vector<Claim>& claims, std::initializer_list<const char*> ids) {
  for (const char* id : ids)
    EXPECT_EQ(verdict(claims, id), Verdict::holds) << id << ": " << find_claim(claims, id)->found;
}

// Verdicts of one view of a bundled scene, which need not be those of the page's views.
TEST(Paper, VerdictsOfHardShadowsStay) {
  HardFindings found{"city", "city", {}, {}, measure_closed_meshes({96, 96})};
  std::array<ShadowTracer, 7> tracers;
  HardView view;
  for (const auto& [file, frame] : {std::pair("city.glb", 150), std::pair("court.glb", 60)}) {
    const auto scene = load_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / file);
    ASSERT_TRUE(scene.has_value());
    evaluate_hard_view(*scene, frame, {192, 192}, view);
    found.figures.push_back(measure_variants(frame, view, 1, tracers));
  }
  found.table = found.figures;
  const auto claims = hard_claims(found);
  expect_rows(claims);
  expect_all_hold(claims,
                  {"olsson.sorting_visits_fewer_nodes", "olsson.precise_visits_fewer_nodes",
                   "olsson.each_improvement_culls", "olsson.small_triangles_still_prune",
                   "olsson.front_culling_saves", "olsson.front_culling_is_exact", "olsson.one_answer"});
  EXPECT_GT(found.closed.shadowed, 500) << "there is something to lose";
}

/// A frame of which variants differ as `cost` says, in nodes and milliseconds.
VariantFrame made_up(std::initializer_list<std::pair<Variant, VariantCost>> costs) {
  VariantFrame frame;
  for (const auto& [variant, cost] : costs) {
    const auto at = std::find(paper_variants.begin(), paper_variants.end(), variant) - paper_variants.begin();
    frame.costs[static_cast<std::size_t>(at)] = cost;
  }
  return frame;
}
VariantFrame timed(double precise_nodes, double precise_ms, double sorted_ms, double sea_ms,
                   double seatp_ms) {
  const auto cost = [](double ms, double nodes) { return VariantCost{.ms = ms, .nodes = nodes}; };
  return made_up({{Variant::spheres, cost(100, 1000)},
                  {Variant::spheres_sorted, cost(100, 900)},
                  {Variant::precise, cost(precise_ms, precise_nodes)},
                  {Variant::precise_sorted, cost(sorted_ms, 100)},
                  {Variant::precise_sea, cost(sea_ms, 90)},
                  {Variant::precise_seatp, cost(seatp_ms, 80)}});
}
Verdict verdict_of_frames(std::vector<VariantFrame> frames, const std::string& id) {
  HardFindings found{"robots", "museum5", frames, frames, {}};
  return verdict(hard_claims(found), id);
}

// The rules of what times decide, on made-up times.
TEST(Paper, RulesOfTimesSayWhatThePaperSays) {
  const VariantFrame wins = timed(800, 90, 50, 55, 60), loses = timed(800, 40, 50, 55, 60),
                     loses_where_coherent = timed(110, 40, 50, 55, 60), gains = timed(800, 90, 50, 30, 60);
  const std::string fastest = "olsson.precise_sorted_is_fastest";
  EXPECT_EQ(verdict_of_frames({wins, wins}, fastest), Verdict::holds);
  EXPECT_EQ(verdict_of_frames({wins, loses}, fastest), Verdict::fails) << "half of the frames are not all";
  EXPECT_EQ(verdict_of_frames({wins, loses_where_coherent}, fastest), Verdict::holds) << "the exception";
  EXPECT_EQ(verdict_of_frames({loses_where_coherent}, fastest), Verdict::not_here);
  const std::string pay = "olsson.improvements_do_not_pay", reverse = "olsson.times_are_the_reverse";
  EXPECT_EQ(verdict_of_frames({wins}, pay), Verdict::holds);
  EXPECT_EQ(verdict_of_frames({wins}, reverse), Verdict::holds);
  EXPECT_EQ(verdict_of_frames({gains}, pay), Verdict::fails);
  EXPECT_EQ(verdict_of_frames({gains}, reverse), Verdict::fails);
  EXPECT_EQ(verdict_of_frames({timed(800, 90, 50, 52, 51)}, reverse), Verdict::holds)
      << "almost, says the paper";
  EXPECT_EQ(verdict_of_frames({timed(800, 90, 50, 60, 51)}, pay), Verdict::holds);
  EXPECT_EQ(verdict_of_frames({timed(800, 90, 50, 60, 51)}, reverse), Verdict::fails);
}

TEST(Paper, CullingHasToLowerTheNodesOfTheWholeAnimation) {
  VariantFrame rises = timed(800, 90, 50, 55, 60), idle = rises;
  rises.costs[5].nodes = 95;  // PreciseSEATP above PreciseSEA's 90
  idle.costs[5].nodes = 90;
  const std::string id = "olsson.each_improvement_culls";
  EXPECT_EQ(verdict_of_frames({timed(800, 90, 50, 55, 60), rises}, id), Verdict::holds) << "80 + 95 < 180";
  EXPECT_EQ(verdict_of_frames({rises}, id), Verdict::fails);
  EXPECT_EQ(verdict_of_frames({idle}, id), Verdict::fails) << "as many are not fewer";
}

TEST(Paper, FrontCullingIsJudgedOnClosedMeshesAlone) {
  const std::string id = "olsson.front_culling_is_exact";
  HardFindings found{"robots", "museum5", {timed(800, 90, 50, 55, 60)}, {}, {}};
  found.table = found.figures;
  EXPECT_EQ(verdict(hard_claims(found), id), Verdict::not_here);
  found.closed = {.pixels = 9, .shadowed = 3, .differing = 0};
  found.figures[0].culled_differing = 7;  // of open meshes
  EXPECT_EQ(verdict(hard_claims(found), id), Verdict::holds);
  found.closed.differing = 1;
  EXPECT_EQ(verdict(hard_claims(found), id), Verdict::fails);
}

TEST(Paper, VerdictsOfSoftShadowsStay) {
  const auto scene = load_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / "court.glb");
  ASSERT_TRUE(scene.has_value());
  SoftView view{.name = "court 60"};
  evaluate_bench_frame(*scene, 60, 24, 14, view.frame);
  const auto light = square_light(view.frame, 1);
  ASSERT_TRUE(light.has_value());
  view.light = *light;
  SoftFindings found;
  found.views.push_back(measure_trees(view, 1));
  found.growth_view = view.name;
  found.areas = grow_light(view, {1, 9});
  found.lights = add_lights(view, {1, 2});
  found.split = split_light(view);
  const auto claims = soft_claims(found);
  expect_rows(claims);
  expect_all_hold(claims, {"mora.robust", "mora.coherence_pays", "mora.larger_lights_cost_more",
                           "mora.lights_are_linear", "mora.huge_lights_can_be_split"});
  EXPECT_LE(found.split.difference_255, 0.5) << "four quarters shine as the whole";
  EXPECT_GT(found.views[0].paper.nodes, found.views[0].largest.nodes)
      << "a random occluder is no best choice";
}

TEST(Paper, MemoryIsNoVerdictWhereTreesCameToTheirBound) {
  SoftFindings found;
  found.views.resize(1);
  found.areas = {{1, {.nodes = 10, .bytes = 1e6}}, {100, {.nodes = 90, .bytes = 2e6}}};
  found.lights = {{1, {.nodes = 10, .bytes = 1e6}}, {4, {.nodes = 40, .bytes = 1e6}}};
  found.split = {.difference_255 = 0.1, .whole_bytes = 5e6, .part_bytes = 4e6};
  const auto of = [&](const std::string& id) { return verdict(soft_claims(found), "mora." + id); };
  EXPECT_EQ(of("larger_lights_cost_more"), Verdict::holds);
  EXPECT_EQ(of("huge_lights_can_be_split"), Verdict::holds);
  found.split.part_bytes = found.split.whole_bytes;
  EXPECT_EQ(of("huge_lights_can_be_split"), Verdict::fails) << "as much is not less";
  found.split.whole_bytes = found.split.part_bytes = static_cast<double>(tree_bound_mib << 20);
  EXPECT_EQ(of("huge_lights_can_be_split"), Verdict::not_here);
  found.views[0].paper.bytes = found.areas.back().cost.bytes = found.split.whole_bytes;
  EXPECT_NE(find_claim(soft_claims(found), "mora.low_memory")->found.find("would have grown"),
            std::string::npos);
  EXPECT_EQ(of("larger_lights_cost_more"), Verdict::not_here);
  EXPECT_EQ(of("largest_light_is_far_from_critical"), Verdict::fails);
}

TEST(Paper, NeighbourhoodsAreJudgedWhereTrianglesHaveFewPoints) {
  SoftFindings found;
  found.views.resize(2);
  found.views[0].points_a_triangle = 3, found.views[0].paper.nodes = 50,
  found.views[0].neighbourhood.nodes = 20;
  found.views[1].points_a_triangle = 900, found.views[1].paper.nodes = 20;
  found.views[1].neighbourhood.nodes = 50;
  const auto judged = [&] { return verdict(soft_claims(found), "mora.neighbourhoods_would_help"); };
  EXPECT_EQ(judged(), Verdict::holds) << "large triangles are not meant";
  found.views[1].points_a_triangle = 4;
  EXPECT_EQ(judged(), Verdict::fails);
  found.views.erase(found.views.begin());
  found.views[0].points_a_triangle = 900;
  EXPECT_EQ(judged(), Verdict::not_here);
}

// The smallest run: few positions and directions, the bundled object. Counts and errors decide; no time does.
TEST(Paper, VerdictsOfAmbientOcclusionStay) {
  PartsArguments arguments;
  arguments.tiny = true;
  PaperSession session(arguments);
  ASSERT_TRUE(measure_paper_ao(session).has_value());
  ASSERT_EQ(session.sections.size(), 1u);
  const auto& claims = session.sections[0].claims;
  expect_rows(claims);
  expect_all_hold(claims,
                  {"gaitatzes.rejection_wastes", "gaitatzes.a_byte_a_ray", "gaitatzes.a_byte_is_enough",
                   "gaitatzes.a_bit_saves", "gaitatzes.a_bit_is_comparable", "gaitatzes.a_bit_is_brighter",
                   "gaitatzes.a_bit_for_far_objects", "gaitatzes.size_does_not_matter"});
}

TEST(Paper, OneBitIsHeldToTheErrorOfEight) {
  AoFindings found;
  found.maps.resize(1), found.figure6.resize(1);
  found.bits = {{.bits = 32, .bytes = 32, .rms = 1},
                {.bits = 8, .bytes = 8, .rms = 1},
                {.bits = 1, .bytes = 1, .rms = 1.9, .brighter = 0.5}};
  found.mixed = {.far_rms = 3, .far_rms_8 = 1};
  const auto of = [&](const std::string& id) { return verdict(ao_claims(found), "gaitatzes." + id); };
  EXPECT_EQ(of("a_bit_is_comparable"), Verdict::holds);
  EXPECT_EQ(of("a_bit_is_brighter"), Verdict::holds);
  EXPECT_EQ(of("a_bit_for_far_objects"), Verdict::fails) << "below the paper's 4.40, yet thrice the error";
  found.bits[2].rms = 2.1, found.bits[2].brighter = 3;
  EXPECT_EQ(of("a_bit_is_comparable"), Verdict::fails);
  EXPECT_EQ(of("a_bit_is_brighter"), Verdict::fails) << "not slightly";
}

TEST(Paper, MapsOfDirectionsAreInverses) {
  constexpr int side = 16;
  for (const DirectionMap map : direction_maps) {
    for (int cell = 0; cell < side * side; ++cell) {
      const glm::vec3 direction = direction_of_cell(map, cell, side);
      if (direction.z < 0) continue;
      EXPECT_NEAR(glm::length(direction), 1, 1e-5);
      EXPECT_EQ(cell_of_direction(map, direction, side), cell) << direction_map_name(map);
    }
  }
  EXPECT_NEAR(unused_cells(DirectionMap::rejection, 128), 1 - 0.785398, 0.005) << "the paper's 21.5 %";
  EXPECT_EQ(unused_cells(DirectionMap::concentric, side), 0);
}

TEST(Paper, TablesTakeAByteOrABitADirection) {
  const Object knot = make_knot(16, 8);
  const ObjectTree tree(knot);
  for (const int bits : {32, 8, 1}) {
    const auto built =
        build_field(knot, tree, {FieldLayout::positions_directions, 289, 256, bits}, Inside::first_hit);
    ASSERT_TRUE(built.has_value());
    EXPECT_EQ((*built)->field.shape.bytes * 8, 289u * 256u * static_cast<unsigned>(bits));
  }
}

TEST(Paper, ThePageHasItsSectionsAndNoNan) {
  const std::string page = page_text();
  for (const char* part : {"## Hard shadows: Olsson and Assarsson 2011", "## Soft shadows: Mora et al. 2012",
                           "## Ambient occlusion: Gaitatzes et al. 2010", "| **true** |", "| **false** |",
                           "| **not testable here** |"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  for (const char* number : {" nan", " inf ", "-nan"}) EXPECT_EQ(page.find(number), std::string::npos);
}

}  // namespace
}  // namespace tenebra::bench
