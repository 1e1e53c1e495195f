// tenebra-bench as a program: it starts, refuses what it cannot do in a sentence, and ends with the lines
// that scripts read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/common/bench_data.h"
#include "bench/common/bench_frame.h"
#include "io/image.h"
#include "support/bart.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

testing::ProgramResult bench(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TENEBRA_BENCH);
  return testing::run_program(arguments);
}

void expect_refusal(const std::vector<std::string>& arguments, const std::string& sentence) {
  const auto result = bench(arguments);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_LT(result.exit_code, 128) << "ended by a signal";
  EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
}

/// Value of the line "name: value"; NaN where it was not measured or is missing.
double figure(const std::string& output, const std::string& name, bool& found) {
  const std::size_t at = output.find("\n" + name + ": ");
  found = at != std::string::npos;
  return found && output.compare(at + name.size() + 3, 12, "not measured") != 0
             ? std::strtod(output.c_str() + at + name.size() + 3, nullptr)
             : NAN;
}

TEST(BenchProgram, RefusesInASentence) {
  expect_refusal({}, "subcommand is required");
  expect_refusal({"soft", "--bogus"}, "--bogus");
  expect_refusal({"soft", "--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_refusal({"soft", "--threads", "many"}, "many");
  expect_refusal({"soft", "--csv"}, "--csv");
  expect_refusal({"soft", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_refusal({"soft", "--pictures", "/nowhere/at/all"}, "--pictures: /nowhere/at/all is not a folder");
  expect_refusal({"soft", "--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  expect_refusal({"soft", "--only", "atlantis"}, "--only: found atlantis, expected");
}

TEST(BenchProgram, HardRefusesInASentence) {
  expect_refusal({"hard", "--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_refusal({"hard", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_refusal({"hard", "--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  expect_refusal({"hard", "--only", "atlantis"},
                 "--only: found atlantis, expected frames, whole, sun, cut, growth, variance");
}

TEST(BenchProgram, HardEndsWithItsFiguresWhereScenesAreMissing) {
  const testing::TemporaryFolder folder;
  const auto result =
      bench({"hard", "--tiny", "--data", folder.path().string(), "--csv", (folder / "hard.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("robots: skipped"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("BART is not in " + folder.path().string()), std::string::npos);
  EXPECT_NE(result.output.find("www.cse.chalmers.se"), std::string::npos) << "where it comes from";
  EXPECT_EQ(result.output.find("nan"), std::string::npos);
  bool found = false;
  for (const char* name : {"hard.dynamic_geomean", "hard.static_geomean", "hard.dynamic_worst",
                           "hard.static_worst", "hard.growth_static_1.8m", "hard.p99_over_median"}) {
    EXPECT_TRUE(std::isnan(figure(result.output, name, found))) << name;
    EXPECT_TRUE(found) << name;
  }
  for (const char* name :
       {"hard.whole_moved_geomean", "hard.whole_moved_worst", "hard.whole_static_geomean",
        "hard.whole_static_worst", "hard.whole_first_moved_worst", "hard.whole_first_static_worst",
        "hard.sun_geomean", "hard.sun_worst", "hard.cut_moved_geomean", "hard.cut_moved_worst"}) {
    EXPECT_GT(figure(result.output, name, found), 0) << "city counts: " << name;
    EXPECT_TRUE(found) << name;
  }
  const std::string csv = testing::read_text(folder / "hard.csv");
  for (const char* row : {"\nframes,city 150,tenebra,", "\nwhole,city 150,tenebra,lights=1,moved_ratio,",
                          "\nsun,city 150,tenebra,lights=1,still_ratio,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
}

TEST(BenchProgram, FrameRefusesInASentence) {
  expect_refusal({"frame", "--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_refusal({"frame", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_refusal({"frame", "--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  expect_refusal({"frame", "--only", "atlantis"}, "--only: found atlantis, expected scenes, files");
}

TEST(BenchProgram, FrameEndsWithItsFigures) {
  const testing::TemporaryFolder folder;
  const auto result =
      bench({"frame", "--tiny", "--data", folder.path().string(), "--csv", (folder / "frame.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("robots: skipped"), std::string::npos) << result.output;
  bool found = false;
  for (const char* name : {"frame.ratio_geomean", "frame.ratio_worst", "frame.unshaded_geomean",
                           "frame.unshaded_worst", "frame.city_per_second"}) {
    EXPECT_GT(figure(result.output, name, found), 0) << name;
    EXPECT_TRUE(found) << name;
  }
  const double files = figure(result.output, "frame.render_over_frames", found);
  EXPECT_TRUE(found);
  EXPECT_TRUE(files > 0 || result.output.find("files: skipped") != std::string::npos) << result.output;
  const std::string csv = testing::read_text(folder / "frame.csv");
  for (const char* row :
       {"\nframe,city 150,tenebra,64x64,raster_time,", "\nframe,city 150,embree,72x40,time,",
        "\nframe,court 60,both,64x64,differing_share,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
}

TEST(BenchProgram, PictureRefusesInASentence) {
  expect_refusal({"picture", "--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_refusal({"picture", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_refusal({"picture", "--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  expect_refusal({"picture", "--only", "atlantis"}, "--only: found atlantis, expected views, flicker");
}

TEST(BenchProgram, PictureEndsWithItsFigures) {
  const testing::TemporaryFolder folder;
  const auto result = bench(
      {"picture", "--tiny", "--data", folder.path().string(), "--csv", (folder / "picture.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("robots: skipped"), std::string::npos) << result.output;
  bool found = false;
  for (const char* name :
       {"picture.rms_4", "picture.rms_16", "picture.cost_4", "picture.cost_16", "picture.flicker_16"}) {
    EXPECT_GT(figure(result.output, name, found), 0) << name;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_GE(figure(result.output, "picture.missed_percent", found), 0);
  EXPECT_TRUE(found);
  const std::string csv = testing::read_text(folder / "picture.csv");
  for (const char* row :
       {"\nviews,city 150,tenebra,samples=16,rms,", "\nviews,court 60,tenebra,samples=4,time,",
        "\nflicker,gallery,tenebra,samples=16,flicker,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
}

TEST(BenchProgram, BakeEndsWithItsFigures) {
  const testing::TemporaryFolder folder;
  expect_refusal({"bake", "--only", "atlantis"}, "--only: found atlantis, expected map");
  const auto result = bench({"bake", "--tiny", "--csv", (folder / "bake.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  bool found = false;
  for (const char* name :
       {"bake.exact_over_rays", "bake.within_over_rays", "bake.exact_over_rays_penumbra", "bake.rays"}) {
    EXPECT_GT(figure(result.output, name, found), 0) << name;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_LT(figure(result.output, "bake.worst_255", found), 0.1) << "what exact soft shadows promise";
  const std::string csv = testing::read_text(folder / "bake.csv");
  for (const char* row : {"\nmap,room,tenebra,exact,time,", "\nmap,room,tenebra,soft_error=0.5,rms,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
}

TEST(BenchProgram, ViewerEndsWithItsFigures) {
  const testing::TemporaryFolder folder;
  expect_refusal({"viewer", "--only", "atlantis"},
                 "--only: found atlantis, expected hands, starts, opens, whole, explain");
  const auto result = bench({"viewer", "--tiny", "--csv", (folder / "viewer.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const bool skipped = result.output.find("viewer: skipped") != std::string::npos;
  bool found = false;
  for (const char* name : {"viewer.pictures_per_second_worst", "viewer.black_ms_worst", "viewer.explain_ms",
                           "viewer.over_render"}) {
    const double value = figure(result.output, name, found);
    EXPECT_TRUE(found) << name;
    EXPECT_TRUE(skipped || value >= 0 || std::string(name) == "viewer.explain_ms") << name << ": " << value;
  }
  // Keys are pressed in a window: that needs Xvfb and xdotool, and the bench says which of them is missing.
  if (skipped) GTEST_SKIP() << result.output.substr(result.output.find("viewer: skipped"));
  const std::string csv = testing::read_text(folder / "viewer.csv");
  for (const char* row :
       {"\nhands,city,tenebra,", "\nstarts,city,tenebra,", "\nopens,", "\nwhole,city,view,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
}

TEST(BenchProgram, TradeRefusesInASentence) {
  expect_refusal({"trade", "--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_refusal({"trade", "--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_refusal({"trade", "--docs", "/nowhere/at/all"}, "--docs: /nowhere/at/all is not a folder");
  expect_refusal({"trade", "--only", "atlantis"},
                 "--only: found atlantis, expected hard, soft, ao, stages, needs");
  expect_refusal({"trade", "--docs", "/proc/self"}, "cannot write /proc/self/trade.md");
}

TEST(BenchProgram, TradeWritesItsPageFromBundledScenesAlone) {
  const testing::TemporaryFolder folder;
  const auto result = bench({"trade", "--tiny", "--data", folder.path().string(), "--docs",
                             folder.path().string(), "--csv", (folder / "trade.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("robots: skipped"), std::string::npos) << result.output;
  bool found = false;
  for (const char* name : {"trade.hard_default_wrong_pixels", "trade.hard_variants_wrong_pixels",
                           "trade.stages_differing", "trade.needs_differing"}) {
    EXPECT_EQ(figure(result.output, name, found), 0) << name;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_LE(figure(result.output, "trade.soft_default_worst_255", found), 0.1);
  EXPECT_TRUE(found);
  const std::string page = testing::read_text(folder / "trade.md"),
                    csv = testing::read_text(folder / "trade.csv");
  for (const char* part :
       {"## Which to choose", "## Hard shadows", "## Soft shadows", "## Ambient occlusion",
        "## Stages switched off alone", "## Only what a scene requires", "| default (Tiles) | "})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("NOT the same"), std::string::npos);
  for (const char* row :
       {"\ntrade hard,city 150,default (Tiles),,time on 1 thread,", "\ntrade soft,court 60,",
        "\ntrade ao,city 150,", "\ntrade stages,knot,", "\ntrade needs,city 150,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row;
  EXPECT_NE(page.find("| exact, other solvers, bsp | "), std::string::npos);
  for (const char* name : {"trade_soft_court_60.png", "trade_ao_city_150.png"}) {
    EXPECT_NE(page.find(name), std::string::npos) << name;
    const auto crops = io::read_png(folder / name);
    ASSERT_TRUE(crops) << name;
    EXPECT_GT(crops->width, crops->height) << name;
  }
  for (const char* name : {"trade_hard_city_150.svg", "trade_soft_court_60.svg", "trade_ao_city_150.svg",
                           "trade_hard_city_150_sun.svg", "trade_soft_city_150_sun.svg"}) {
    EXPECT_NE(page.find(name), std::string::npos) << name;
    EXPECT_NE(testing::read_text(folder / name).find("</svg>"), std::string::npos) << name;
  }
}

TEST(BenchProgram, TradeLeavesSectionsOfOtherPartsAsTheyAre) {
  const testing::TemporaryFolder folder;
  const std::string hard = "## Hard shadows\n\nAs it was.\n\n",
                    needs = "## Only what a scene requires\n\nToo.\n";
  testing::write_text(folder / "trade.md",
                      "# Old\n\n" + hard + "## Ambient occlusion\n\nOld too.\n\n" + needs);
  const auto result = bench({"trade", "--tiny", "--only", "ao", "--data", folder.path().string(), "--docs",
                             folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string page = testing::read_text(folder / "trade.md");
  EXPECT_EQ(page.find("Old"), std::string::npos);
  EXPECT_NE(page.find("| adaptive, error 2.5 |"), std::string::npos);
  EXPECT_NE(page.find(hard), std::string::npos);
  EXPECT_TRUE(page.ends_with(needs));
}

TEST(BenchData, NamesTheFilesThatAreNotThoseOfTheFigures) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "robots");
  testing::write_text(folder / "robots/Robot.aff", "# another one\n");
  const auto sentences = data_sentences(folder.path());
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find(
                " of BART's files are missing or differ from those of the documented figures (kitchen/"),
            std::string::npos)
      << sentences[0];
  if (testing::bart_has_textures()) {
    EXPECT_TRUE(data_sentences(testing::bart_folder()).empty());
  }
}

TEST(BenchData, ThePartThatComesWithTheTestsLacksTexturesAlone) {
  const std::string sums =
      testing::read_text(std::filesystem::path(TENEBRA_SCENES_DIR) / "../tests/reference/bart.sha256");
  int textures = 0;
  for (std::size_t at = 0; (at = sums.find(".ppm\n", at)) != std::string::npos; ++at) ++textures;
  const auto sentences = data_sentences(testing::bart_part());
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find(": " + std::to_string(textures) + " of BART's files are missing"),
            std::string::npos)
      << sentences[0];
}

TEST(BenchProgram, PaperWritesItsPageFromBundledScenesAlone) {
  const testing::TemporaryFolder folder;
  expect_refusal({"paper", "--docs", "/nowhere/at/all"}, "--docs: /nowhere/at/all is not a folder");
  expect_refusal({"paper", "--stride", "-1"}, "--stride: found -1, expected 0");
  expect_refusal({"paper", "--only", "atlantis"}, "--only: found atlantis, expected hard, soft, ao, bart");
  testing::write_text(folder / "papers.md", "# Old\n\n## Soft shadows: Mora et al. 2012\n\nAs it was.\n");
  const auto result = bench({"paper", "--tiny", "--only", "hard,bart", "--data", folder.path().string(),
                             "--docs", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("robots: skipped"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("www.cse.chalmers.se"), std::string::npos) << "where BART comes from";
  const std::string page = testing::read_text(folder / "papers.md");
  EXPECT_NE(page.find("| Figure 6(a) | "), std::string::npos) << page;
  EXPECT_NE(page.find("## Soft shadows: Mora et al. 2012\n\nAs it was.\n"), std::string::npos);
  EXPECT_NE(page.find("--only ao --docs docs`"), std::string::npos) << "not made yet";
  EXPECT_NE(page.find("\n| city | 2 of 300 | "), std::string::npos) << page;
  EXPECT_EQ(page.find(" nan"), std::string::npos) << page;
  EXPECT_NE(testing::read_text(folder / "papers_hard_figure6_nodes.svg").find("</svg>"), std::string::npos);
}

TEST(BenchProgram, HelpNamesTheOptions) {
  const auto result = bench({"soft", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* option : {"--data", "--quick", "--threads", "--csv", "--pictures"})
    EXPECT_NE(result.output.find(option), std::string::npos) << option;
}

TEST(BenchProgram, ATinyRunNamesWhatIsMissingAndEndsWithTheFigures) {
  const testing::TemporaryFolder folder;
  const auto result = bench({"soft", "--quick", "--data", folder.path().string(), "--size", "32", "24",
                             "--csv", (folder / "soft.csv").string(), "--pictures", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* scene : {"robots", "museum5", "kitchen", "museum5x64"})
    EXPECT_NE(result.output.find(std::string(scene) + ": skipped"), std::string::npos) << scene;
  bool found = false;
  for (const char* name : {"soft.eq_geomean", "soft.eq_worst", "soft.fair_worst"}) {
    EXPECT_TRUE(std::isnan(figure(result.output, name, found))) << "no counted view, no figure: " << name;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_LE(figure(result.output, "soft.max_error_255", found), 0.1);
  const double trees_mb = figure(result.output, "soft.peak_tree_mb", found);
  EXPECT_GT(trees_mb, 0) << "of trees, which the default does not grow";
  EXPECT_LE(trees_mb, 64);
  EXPECT_EQ(result.output.find('\n', result.output.find("\nsoft.peak_tree_mb: ") + 1),
            result.output.size() - 1)
      << "the last line";

  const std::string csv = testing::read_text(folder / "soft.csv");
  EXPECT_NE(csv.find("\nexperiment,view,contestant,parameter,quantity,value,unit\n"), std::string::npos);
  for (const char* row : {"figure7,court", "trees,court"}) EXPECT_NE(csv.find(row), std::string::npos) << row;
  std::size_t pictures = 0;
  for (const std::string& name : folder.names()) pictures += name.ends_with(".png") ? 1 : 0;
  EXPECT_EQ(pictures, 2u);
}

}  // namespace
}  // namespace tenebra::bench
