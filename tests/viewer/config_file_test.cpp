// --config: names and sections that nothing reads, words in any case.
#include <gtest/gtest.h>
#include <sys/stat.h>

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
