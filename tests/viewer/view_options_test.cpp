// tenebra view without a window: options that are refused, the missing display, and that settings survive the
// way to their arguments and back.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "options/memory_option.h"
#include "options/method_arguments.h"
#include "shared/picture_difference.h"
#include "viewer_test_scene.h"
#include "window/view_options.h"

namespace tenebra::testing {
namespace {

using viewer::MethodOptions;

TEST(ViewCommand, RefusesInASentence) {
  const std::vector<std::vector<std::string>> cases{{"--speed", "5"},
                                                    {"--wipe", "2"},
                                                    {"--set-light", "0 glow=1"},
                                                    {"--compare=--shadows purple"},
                                                    {"--compare=--no-such-option"},
                                                    {"--overlay", "cost"},
                                                    {"--record", "out.png"},
                                                    {"--window", "0x0"},
                                                    {"--exit-after", "-1"},
                                                    {"--preview-budget", "-1"},
                                                    {"--preview-budget", "1001"},
                                                    {"--preview-budget", "soon"},
                                                    {"--paper", "samples=depth", "--shadows", "soft"}};
  for (auto arguments : cases) {
    arguments.insert(arguments.begin(), "view");
    const auto result = tenebra(arguments, [] { ::unsetenv("DISPLAY"); });
    EXPECT_EQ(result.exit_code, 1) << arguments[1];
    EXPECT_TRUE(is_one_sentence(result.errors)) << arguments[1] << ": " << result.errors;
  }
}

TEST(ViewCommand, NamesWhatTheSecondMethodLacks) {
  for (const auto& [option, sentence] :
       {std::pair{"--compare=--help", "--compare: The following argument was not expected: --help"},
        {"--compare=--quality", "--compare: --quality: found no value, expected fast|balanced|exact"},
        {"--compare=--quality best", "--compare: --quality: found best, expected fast, balanced or exact"}}) {
    const auto result = tenebra({"view", option}, [] { ::unsetenv("DISPLAY"); });
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  }
}

TEST(ViewCommand, SaysWhatToDoWithoutADisplay) {
  const auto result = tenebra({"view"}, [] {
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
  });
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  EXPECT_NE(result.errors.find("display"), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("tenebra render"), std::string::npos) << result.errors;
}

MethodOptions parsed(const std::string& text) {
  MethodOptions method;
  std::optional<int> memory_mb;
  CLI::App app;
  viewer::add_method_options(app, method);
  viewer::add_memory_option(app, memory_mb);
  app.parse(text);
  viewer::settle_quality(app, method);
  return method;
}

/// The same with --memory.
MethodOptions settled(const std::string& text) {
  MethodOptions method;
  std::optional<int> memory_mb;
  CLI::App app;
  viewer::add_method_options(app, method);
  viewer::add_memory_option(app, memory_mb);
  app.parse(text);
  viewer::settle_memory(app, memory_mb, method);
  return method;
}

TEST(MethodArguments, GiveBackWhatTheyWereMadeFrom) {
  EXPECT_EQ(viewer::method_arguments(parsed("")), "");
  for (const char* text :
       {"--shadows none", "--light 2 --exposure 0.1 --tone aces --threads 3", "--exposure auto",
        "--simd scalar --paper variant=PreciseSEATP", "--paper samples=depth --paper cull=none",
        "--paper cull=front",
        "--shadows soft --light-size 0.5x0.25 --light-size facing=1,2.5,-3 --light-size emission=lambert "
        "--emissive-lights --paper soft-solver=bsp "
        "--paper soft-grouping=triangle --paper soft-choice=random --memory soft:300 "
        "--paper soft-points=12 --soft-error 1.5",
        "--light-size 4x4%", "--light-size sun=0.53",
        "--ao field --paper ao-at=vertices --paper ao-layout=positions --ao-rays 7 --paper ao-downscale=3 "
        "--ao-distance 1.5 "
        "--paper ao-positions=99 "
        "--paper ao-directions=64 --paper ao-bits=1 --paper ao-deforming=none --ao-cache none --memory "
        "ao:100"}) {
    EXPECT_EQ(viewer::method_arguments(parsed(text)), text);
  }
}

TEST(MemoryOption, GivesSoftShadowsHalfUnlessTheyHaveTheirOwn) {
  for (const auto& [text, soft_mb, largest_tree] :
       {std::tuple("", 0, 4 << 20), {"--memory 300", 150, 4 << 20}, {"--memory 1", 1, 4 << 20}}) {
    const SoftShadowConfig soft = settled(text).render.soft;
    EXPECT_EQ(soft.memory_bytes.value_or(0), std::size_t(soft_mb) << 20) << text;
    EXPECT_EQ(soft.tree_bytes, std::size_t(largest_tree)) << text;
  }
  const SoftShadowConfig own = settled("--memory 300 --memory soft:200").render.soft;
  EXPECT_EQ(own.memory_bytes, std::size_t{200} << 20);
  EXPECT_GT(own.tree_bytes, std::size_t{200} << 20) << "trees of any size";
}

TEST(PictureDifference, CountsAndShowsWhatDiffers) {
  const io::Image8 a{2, 1, 3, {10, 20, 30, 200, 200, 200}};
  const io::Image8 b{2, 1, 3, {10, 25, 30, 200, 100, 201}};
  const auto difference = viewer::compare_pictures(a, b, 0);
  EXPECT_EQ(difference.pixels, 2u);
  EXPECT_EQ(difference.differing, 2u);
  EXPECT_EQ(difference.largest, 100);
  EXPECT_EQ(viewer::compare_pictures(a, b, 5).differing, 1u);
  EXPECT_EQ(viewer::absolute_difference(a, b, 4).pixels, (std::vector<std::uint8_t>{0, 20, 0, 0, 255, 4}));
}

TEST(ViewCommand, AnotherFileKeepsWhatSpeaksOfNoPartOfTheScene) {
  viewer::SceneOptions options;
  options.file = "a.glb";
  options.import.scene = "second";
  options.import.root = "models";
  options.import.texture_paths = {"pictures"};
  options.transfer = Transfer::display;
  options.environment = "sky.hdr";
  options.plain = options.cast_all = true;
  options.cutout_limit = 7;
  options.camera = "near";
  options.clip = "walk";
  options.no_cast = {"sky"};
  const viewer::SceneOptions other = viewer::settings_for("b.glb", options);
  EXPECT_EQ(other.file, "b.glb");
  EXPECT_EQ(other.import.texture_paths, options.import.texture_paths);
  EXPECT_EQ(other.transfer, Transfer::display);
  EXPECT_EQ(other.environment, "sky.hdr");
  EXPECT_TRUE(other.plain && other.cast_all);
  EXPECT_EQ(other.cutout_limit, 7);
  EXPECT_TRUE(other.import.scene.empty() && other.import.root.empty() && other.no_cast.empty());
  EXPECT_FALSE(other.camera || other.clip);
}

}  // namespace
}  // namespace tenebra::testing
