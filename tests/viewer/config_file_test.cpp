// --config: names and sections that nothing reads, words in any case.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>

#include "options/render_options.h"
#include "settings/choices.h"
#include "settings/nearest_word.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

/// What `render` says to a file with this text.
std::string refusal(const TemporaryFolder& folder, const std::string& text) {
  write_text(folder / "my.cfg", text);
  const auto result =
      tenebra({"render", write_moving_scene(folder), "--config", folder / "my.cfg", "-o", "none", "--quiet"});
  EXPECT_EQ(result.exit_code, result.errors.empty() ? 0 : 1);
  EXPECT_TRUE(result.errors.empty() || is_one_sentence(result.errors)) << result.errors;
  return result.errors;
}

TEST(ConfigFile, RefusesWhatNothingReads) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const std::string& said) {
    const std::string found = refusal(folder, text);
    EXPECT_NE(found.find(said), std::string::npos) << text << found;
  };
  expect("[redner]\nsize = 40x30\n", "the section [redner], expected [");
  expect("[redner]\nsize = 40x30\n", "(did you mean [render]?)");
  expect("[verify]\nsize = 4x4\n[mirror]\nsize = 4x4\n", "the section [mirror], expected [");
  expect("[render.more]\nsize = 4x4\n", "the section [render.more]");
  expect("siez = 40x30\n",
         "'siez', expected the long name of an option of tenebra render (did you mean size?)");
  expect("[view]\nwidth-of-all = 3\n",
         "'view.width-of-all', expected the long name of an option of tenebra view");
  expect("[view]\ncompere = 3\n", "(did you mean compare?)");
  EXPECT_EQ(refusal(folder, "size = 40x30\n[view]\ncompare = --shadows soft\n[verify]\nsamples = 9\n"), "");
}

/// What `render` makes of a command line, with a file of this text where there is one.
viewer::RenderOptions read_options(const std::string& line, const std::string& text = "") {
  const TemporaryFolder folder;
  write_text(folder / "my.cfg", text);
  viewer::RenderOptions options;
  CLI::App app;
  viewer::add_render_options(app, options);
  app.parse("a.glb --config " + (folder / "my.cfg").string() + " " + line);
  return options;
}
std::vector<std::string> names_of(const std::vector<viewer::OutputPattern>& patterns) {
  std::vector<std::string> names;
  for (const viewer::OutputPattern& pattern : patterns) names.push_back(pattern.text());
  return names;
}
using Names = std::vector<std::string>;

TEST(ConfigFile, GivesEveryKeyThatTheCommandLineDoesNotGive) {
  const std::string two = R"(mask = ["colour:a.png", "colour:b.pfm", "c.png"])";
  EXPECT_EQ(names_of(read_options("", two).mask_colours), (Names{"a.png", "b.pfm"}));
  EXPECT_EQ(names_of(read_options("", two).masks), Names{"c.png"});
  const viewer::RenderOptions both = read_options("--mask colour:d.png", two);
  EXPECT_EQ(names_of(both.mask_colours), Names{"d.png"});
  EXPECT_EQ(names_of(both.masks), Names{"c.png"}) << "a key of an option is not the option";
}

TEST(ConfigFile, MayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal(folder, "\xEF\xBB\xBFsize = 40x30\n"), "");
}

TEST(ConfigFile, KeysLeaveTheValueOfTheirOption) {
  const auto sized = read_options("--light-size sun=1", "light-size = 5%").method;
  EXPECT_EQ(sized.light_size, (viewer::LightSize{glm::vec2(5), true}));
  EXPECT_EQ(sized.render.area_lights.sun_deg, 1.0f);
  EXPECT_EQ(read_options("--memory soft:300", "memory = 900").memory_mb, 900);
  EXPECT_EQ(read_options("--log trace:t.json", "log = f.csv").log, "f.csv");
  EXPECT_EQ(read_options("--light-size 2", "light-size = 5%").method.light_size->percent, false);
}

TEST(ConfigFile, TakesVectorsOfKeysWithoutQuotes) {
  for (const char* text : {"light-size = facing=0,1.5,-4", "light-size = \"facing=0,1.5,-4\"",
                           "light-size = [\"2\", \"facing=0,1.5,-4\"]"})
    EXPECT_EQ(read_options("", text).method.light_facing, glm::dvec3(0, 1.5, -4)) << text;
}

TEST(ConfigFile, OldNamesAndKeysAddUp) {
  EXPECT_EQ(names_of(read_options("--mask-colour a.png --mask colour:b.png").mask_colours),
            (Names{"a.png", "b.png"}));
  EXPECT_EQ(names_of(read_options("--mask colour:b.png --mask-colour a.png").mask_colours),
            (Names{"a.png", "b.png"}));
}

TEST(ConfigFile, IdleKeysAreNamedOnce) {
  const TemporaryFolder folder;
  const auto result = tenebra({"render", write_moving_scene(folder), "--size", "16x12", "-o", "none",
                               "--frames", "0", "--light-size", "sun=1"});
  EXPECT_NE(result.errors.find("--light-size sun does nothing"), std::string::npos) << result.errors;
  EXPECT_EQ(result.errors.find("--light-size does nothing"), std::string::npos) << result.errors;
}

TEST(ConfigFile, DoesNotWaitForAPipe) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  ChildProgram render({TENEBRA_PROGRAM, "render", write_moving_scene(folder), "--config", folder / "pipe"});
  const auto result = render.wait(10);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
}

TEST(Words, MayBeWrittenInAnyCase) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra({"render",     scene,
                               "--size",     "20x10",
                               "--frames",   "0",
                               "--paper",    "variant=preciseSEATP",
                               "--simd",     "Scalar",
                               "--shadows",  "Hard",
                               "--light",    "ALL",
                               "--paper",    "cull=NONE",
                               "--raster",   "CPU",
                               "--tone",     "Aces",
                               "--quality",  "Fast",
                               "--floor",    "Auto",
                               "--transfer", "sRGB",
                               "--exposure", "AUTO",
                               "-o",         folder / "a.png",
                               "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(refusal(folder, "shadows = SOFT\nlight-size = 1\nquiet = true\n"), "");
}

TEST(Words, NearestIsFoundOrNone) {
  const std::vector<std::string> known{"size", "shadows", "simd", "light-size"};
  EXPECT_EQ(viewer::nearest_word("siez", known), "size");
  EXPECT_EQ(viewer::nearest_word("SHADOW", known), "shadows");
  EXPECT_EQ(viewer::nearest_word("lightsize", known), "light-size");
  EXPECT_EQ(viewer::nearest_word("frames", known), "");
  EXPECT_EQ(viewer::nearest_word("", known), "");
  EXPECT_EQ(viewer::nearest_word(std::string(100000, 's'), known), "");
}

}  // namespace
}  // namespace tenebra::testing
