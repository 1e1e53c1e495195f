// The user's changes to lights: as text, and their effect on the command line.
#include <gtest/gtest.h>

#include "io/image.h"
#include "options/settings_names.h"
#include "viewer_test_scene.h"

namespace tenebra::viewer {
namespace {

using testing::TemporaryFolder;

TEST(LightEdits, ReadBackWhatTheyWrite) {
  stage::LightEdits edits(4);
  edits[3] = {.on = false,
              .intensity = 0.3f,
              .move = {1, -2.5f, 1e-7f},
              .size_m = glm::vec2(0.1f, 7),
              .diameter_deg = 0.53f};
  const auto texts = light_edit_texts(edits);
  ASSERT_EQ(texts.size(), 1u) << "lights as the scene has them need no words";
  stage::LightEdits read;
  ASSERT_TRUE(parse_light_edit(texts[0], read));
  EXPECT_EQ(read, edits);
}

TEST(LightEdits, RefuseInASentence) {
  for (const char* text : {"", "x", "-1 on=0", "0 on=2", "0 intensity=-1", "0 intensity=nan",
                           "0 intensity=1e-60", "0 move=1,2", "0 glow=1", "0 size", "0 size=0",
                           "0 size=1x1x1", "0 size=4%", "0 diameter=-1", "0 diameter=91", "0 diameter=nan"}) {
    stage::LightEdits edits;
    const auto parsed = parse_light_edit(text, edits);
    EXPECT_FALSE(parsed) << text;
    if (!parsed) {
      EXPECT_NE(parsed.error().message.find("expected"), std::string::npos) << text;
    }
  }
}

io::Image8 rendered(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"--size", "80x60", "--quiet", "-o", folder / "picture.png"});
  const auto result = testing::tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  auto image = io::read_png(folder / "picture.png");
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(*image) : io::Image8{};
}

TEST(SetLight, DrawsWhatTheOtherOptionsDraw) {
  const TemporaryFolder folder;
  const std::string scene = testing::write_moving_scene(folder, 2);
  const auto soft = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {scene, "--shadows", "soft"});
    return rendered(folder, more);
  };
  const io::Image8 first = rendered(folder, {scene, "--light", "0"});
  EXPECT_NE(rendered(folder, {scene}), first);
  EXPECT_EQ(rendered(folder, {scene, "--set-light", "1 on=0"}), first);
  EXPECT_EQ(rendered(folder, {scene, "--set-light", "0 move=1,0,0", "--light", "0"}),
            rendered(folder, {scene, "--light", "1"}))
      << "the second light stands a metre beside the first";
  const io::Image8 sized = soft({"--light-size", "1x0.5"});
  EXPECT_EQ(soft({"--set-light", "0 size=1x0.5", "--set-light", "1 size=1x0.5"}), sized);
  EXPECT_EQ(soft({"--set-light", "1 size=1x0.5", "--light-size", "1x0.5"}), sized);
  const io::Image8 one = soft({"--set-light", "1 size=1x0.5", "--light", "1"});
  EXPECT_EQ(soft({"--light-size", "1x0.5", "--light", "1"}), one) << "light 0 has no part in it";
  EXPECT_NE(soft({"--set-light", "1 size=2x0.5", "--light", "1"}), one);
}

TEST(SetLight, GivesASunItsDiameter) {
  const TemporaryFolder folder;
  const std::string scene = testing::write_moving_scene(folder);
  const auto sunny = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {scene, "--add-light", "directional direction=-0.3,-1,-0.2", "--light", "1"});
    return rendered(folder, more);
  };
  const io::Image8 hard = sunny({}), soft = sunny({"--shadows", "soft", "--sun-size", "6"});
  EXPECT_NE(soft, hard);
  EXPECT_EQ(sunny({"--shadows", "soft", "--set-light", "1 diameter=6"}), soft);
  EXPECT_EQ(sunny({"--shadows", "soft", "--set-light", "1 diameter=6", "--sun-size", "0.5"}), soft);
  EXPECT_EQ(sunny({"--shadows", "soft", "--sun-size", "0"}), hard);
}

TEST(SetLight, CountsEachPlaceOfASharedLight) {
  const TemporaryFolder folder;
  const std::string scene = testing::write_moving_scene(folder, 2);
  const io::Image8 first = rendered(folder, {scene, "--light", "0"});
  std::string text = testing::read_text(scene);
  const auto second = text.find(R"("light":1)");
  ASSERT_NE(second, std::string::npos);
  testing::write_text(scene, text.replace(second, 9, R"("light":0)"));
  EXPECT_EQ(rendered(folder, {scene, "--set-light", "1 on=0"}), first);
}

TEST(SetLight, NumbersMasksAsTheSceneDoes) {
  const TemporaryFolder folder;
  const std::string scene = testing::write_moving_scene(folder, 2);
  rendered(folder, {scene, "--set-light", "0 on=0", "--mask", folder / "mask.png"});
  EXPECT_FALSE(std::filesystem::exists(folder / "mask_L0.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "mask_L1.png"));
}

TEST(SetLight, OfALightThatTheSceneLacksIsRefusedBeforeAWindowOpens) {
  const TemporaryFolder folder;
  const std::string scene = testing::write_moving_scene(folder, 2);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--light", "2"}, {"--set-light", "2 on=0"}, {"--set-light", "0 size=0"}}) {
    for (const char* command : {"render", "view"}) {
      const auto result =
          testing::tenebra({command, scene, wrong[0], wrong[1]}, [] { ::unsetenv("DISPLAY"); });
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_TRUE(testing::is_one_sentence(result.errors)) << result.errors;
      EXPECT_TRUE(result.errors.starts_with("tenebra: " + wrong[0] + ": found ")) << result.errors;
    }
  }
}

}  // namespace
}  // namespace tenebra::viewer
