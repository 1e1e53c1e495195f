// The papers' claims that counts decide, on small pictures of the bundled scenes, and the committed page.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/common/bench_scenes.h"
#include "bench/paper/paper_ao.h"
#include "bench/paper/paper_hard.h"
#include "bench/paper/paper_soft.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
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

// Verdicts of one view of a bundled scene, which need not be those of the page's views.
TEST(Paper, VerdictsOfHardShadowsStay) {
  const auto scene = load_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / "city.glb");
  ASSERT_TRUE(scene.has_value());
  HardFindings found{"city", "city", {}, {}};
  std::array<ShadowTracer, 7> tracers;
  HardView view;
  evaluate_hard_view(*scene, 150, {128, 128}, view);
  found.figures.push_back(measure_variants(150, view, 1, tracers));
  found.table = found.figures;
  const auto claims = hard_claims(found);
  expect_rows(claims);
  for (const char* id : {"olsson.sorting_visits_fewer_nodes", "olsson.precise_visits_fewer_nodes",
                         "olsson.each_improvement_culls", "olsson.small_triangles_still_prune",
                         "olsson.front_culling_saves", "olsson.one_answer"})
    EXPECT_EQ(verdict(claims, id), Verdict::holds) << id << ": " << find_claim(claims, id)->found;
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
  for (const char* id : {"mora.robust", "mora.coherence_pays", "mora.larger_lights_cost_more"})
    EXPECT_EQ(verdict(claims, id), Verdict::holds) << id << ": " << find_claim(claims, id)->found;
  EXPECT_LE(found.split.difference_255, 0.5) << "four quarters shine as the whole";
  EXPECT_GT(found.views[0].paper.nodes, found.views[0].largest.nodes)
      << "a random occluder is no best choice";
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
