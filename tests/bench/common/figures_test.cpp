// Counts that the documentation states, counted again: docs/figures.md and docs/papers.md. Times are in no
// test.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/paper/paper_hard.h"
#include "bench/paper/paper_soft.h"
#include "support/bart.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

std::string page(const char* name) {
  return testing::read_text(std::filesystem::path(TENEBRA_SCENES_DIR) / ".." / "docs" / name);
}

using Cells = std::vector<std::string>;

/// The rows of the first table of `text` whose header begins with `header`, without the header.
std::vector<Cells> table_rows(const std::string& text, const std::string& header) {
  std::vector<Cells> rows;
  std::istringstream lines(text.substr(std::min(text.find("| " + header), text.size())));
  std::string line;
  for (int number = 0; std::getline(lines, line) && line.starts_with("|"); ++number) {
    if (number < 2) continue;  // header and rule
    Cells cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    rows.push_back(cells);
  }
  return rows;
}

/// "robots 640": the scene, as the benches load it, and the frame.
struct Place {
  Scene scene;
  int frame = 0;
};
Place place_of(const std::string& view) {
  std::istringstream words(view);
  std::string name;
  Place place;
  words >> name >> place.frame;
  const BenchScene& known = bench_scene(name);
  std::unique_ptr<testing::TemporaryFolder> made;
  auto scene = load_scene(find_scene(known, testing::bart_folder(), made), known.no_cast);
  EXPECT_TRUE(scene.has_value()) << view << ": " << scene.error().message;
  if (scene) place.scene = std::move(*scene);
  return place;
}

TEST(Figures, HardShadowsStateTheCastersThatTheScenesHave) {
  const auto rows = table_rows(page("figures.md"), "frame | triangles | moved, ms");
  ASSERT_GE(rows.size(), 6u);
  for (const Cells& row : rows) {
    if (row[0].starts_with("museum5x64")) continue;  // to make it takes longer than all the rest
    const Place place = place_of(row[0]);
    HardView view;
    evaluate_hard_view(place.scene, place.frame, {16, 16}, view);
    ShadowTracer tracer;
    ShadowMask mask;
    tracer.trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, {}, mask);
    EXPECT_EQ(counted(static_cast<double>(tracer.stats().triangles)), row[1]) << row[0];
  }
}

// The frame that the paper speaks of, at its size of picture.
TEST(Figures, PapersStateTheNodesOfTheRobotsAtTheWall) {
  const Place place = place_of("robots 160");
  HardView view;
  evaluate_hard_view(place.scene, place.frame, {}, view);
  std::array<ShadowTracer, 7> tracers;
  const VariantFrame frame = measure_variants(place.frame, view, 1, tracers);
  const auto nodes = [&](Variant variant) { return counted(frame.of(variant).nodes); };
  const std::string says =
      fmt::format("Below the root: Spheres {}, SpheresSorted {}, Precise {}, PreciseSorted {}; {} triangles",
                  nodes(Variant::spheres), nodes(Variant::spheres_sorted), nodes(Variant::precise),
                  nodes(Variant::precise_sorted), counted(frame.triangles));
  EXPECT_NE(page("papers.md").find(says), std::string::npos) << says;
}

TEST(Figures, PapersStateWhatCoherenceIsWorthInTheMuseum) {
  const Place place = place_of("museum5 20");
  SoftView view{.name = "museum5 20"};
  evaluate_bench_frame(place.scene, place.frame, 1280, 720, view.frame);
  const auto light = square_light(view.frame, 4);
  ASSERT_TRUE(light.has_value());
  view.light = *light;
  const TreeView trees = measure_trees(view, 16);
  for (const Cells& row : table_rows(page("papers.md"), "view | triangles | s | trees MB")) {
    if (row[0] != view.name) continue;
    EXPECT_EQ(row[1], counted(trees.triangles));
    EXPECT_EQ(row[8], fmt::format("{:.2f}", trees.anew.nodes / trees.kept.nodes));
    EXPECT_EQ(row[10], fmt::format("{:.2f}", trees.paper.nodes / trees.largest.nodes));
    EXPECT_EQ(row[11], fmt::format("{:.2f}", trees.paper.nodes / trees.neighbourhood.nodes));
    return;
  }
  FAIL() << "no row of " << view.name;
}

}  // namespace
}  // namespace tenebra::bench
