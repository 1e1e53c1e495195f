// The user's changes to a scene: as text, their effect, undo and redo.
#include <gtest/gtest.h>

#include "io/image.h"
#include "options/settings_names.h"
#include "viewer_test_scene.h"
#include "window/undo_history.h"

namespace tenebra::viewer {
namespace {

using glm::vec3;
using testing::TemporaryFolder;

stage::SceneEdits some_of_everything() {
  stage::SceneEdits edits;
  edits.lights.resize(2);
  edits.lights[1] = {.intensity = 0.5f, .color = vec3(1, 0.25f, 0), .direction = vec3(0.5f, -1, 1e-7f)};
  edits.added = {{.type = LightType::spot, .position = {1, 2, -3}, .intensity = 7, .color = {0, 1, 0.5f}},
                 {.type = LightType::directional, .direction = vec3(0, 0, 1)}};
  edits.materials[3] = {.color = vec3(0.1f, 0.2f, 0.3f), .roughness = 0.75f};
  edits.materials[0] = {.emissive = vec3(2, 0, 0), .specular = vec3(0.5f), .metallic = 1.0f};
  edits.nodes[5] = {.visible = false};
  edits.nodes[2] = {.casts = false};
  return edits;
}

TEST(SceneEdits, ReadBackWhatTheyWrite) {
  const stage::SceneEdits edits = some_of_everything();
  stage::SceneEdits read;
  for (const EditOption& option : edit_options(edits)) {
    const std::string name = option.name;
    const auto parsed = name == "--set-light"      ? parse_light_edit(option.value, read.lights)
                        : name == "--add-light"    ? parse_added_light(option.value, read)
                        : name == "--set-material" ? parse_material_edit(option.value, read)
                                                   : parse_node_edit(option.value, read);
    ASSERT_TRUE(parsed) << option.value << ": " << parsed.error().message;
  }
  EXPECT_EQ(read, edits);
  EXPECT_TRUE(edit_options({}).empty()) << "a scene as it is needs no words";
}

TEST(SceneEdits, RefuseInASentence) {
  stage::SceneEdits edits;
  for (const char* text : {"", "moon", "point glow=1", "point intensity=-1", "directional direction=0,0,0",
                           "spot color=-1,0,0", "point position=1,2"})
    EXPECT_NE(parse_added_light(text, edits).error().message.find("expected"), std::string::npos) << text;
  for (const char* text :
       {"", "x", "0 color=1", "0 roughness=2", "0 roughness=nan", "0 metallic=1x", "0 shine=1"})
    EXPECT_NE(parse_material_edit(text, edits).error().message.find("expected"), std::string::npos) << text;
  for (const char* text : {"", "-1 visible=0", "0 visible=2", "0 casts", "0 size=1"})
    EXPECT_NE(parse_node_edit(text, edits).error().message.find("expected"), std::string::npos) << text;
  for (const char* text : {"0 direction=0,0,0", "0 color=0,-1,0"})
    EXPECT_NE(parse_light_edit(text, edits.lights).error().message.find("expected"), std::string::npos)
        << text;
}

io::Image8 rendered_moving(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"render", testing::write_moving_scene(folder)});
  arguments.insert(arguments.end(), {"--size", "80x60", "--quiet", "-o", folder / "picture.png"});
  const auto result = testing::tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  auto image = io::read_png(folder / "picture.png");
  return image ? std::move(*image) : io::Image8{};
}

TEST(SceneEdits, AreOptionsOfRender) {
  const TemporaryFolder folder;
  const io::Image8 plain = rendered_moving(folder, {});
  const auto sum = [](const io::Image8& image) {
    std::size_t total = 0;
    for (const std::uint8_t value : image.pixels) total += value;
    return total;
  };
  const io::Image8 no_shadow = rendered_moving(folder, {"--set-node", "1 casts=0"});
  EXPECT_GT(sum(no_shadow), sum(plain)) << "the blocker's shadow is gone";
  EXPECT_NE(rendered_moving(folder, {"--set-node", "1 visible=0"}), no_shadow) << "and now the blocker";
  EXPECT_LT(sum(rendered_moving(folder, {"--set-material", "0 color=0.05,0.05,0.05"})), sum(plain));
  EXPECT_GT(sum(rendered_moving(folder, {"--add-light", "directional direction=0,-1,0 intensity=2"})),
            sum(plain));
  EXPECT_EQ(rendered_moving(folder, {"--add-light", "point position=1,2,3", "--set-light", "1 on=0"}), plain);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--set-material", "1 color=1,0,0"}, {"--set-node", "4 casts=0"}}) {
    const auto result = testing::tenebra({"render", folder / "moving.gltf", wrong[0], wrong[1]});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(testing::is_one_sentence(result.errors)) << result.errors;
    EXPECT_TRUE(result.errors.starts_with("tenebra: " + wrong[0] + ": found ")) << result.errors;
  }
}

TEST(UndoHistory, StepsBackAndForthByMomentsOfRest) {
  stage::SceneEdits edits;
  UndoHistory history;
  history.begin(edits);
  EXPECT_FALSE(history.undo(edits));
  for (const float x : {1.0f, 2.0f, 3.0f}) {  // one drag
    edits.light(0).move.x = x;
    history.follow(edits, x == 3.0f);
  }
  edits.nodes[1].visible = false;
  history.follow(edits, true);
  history.follow(edits, true);
  EXPECT_TRUE(history.undo(edits));
  EXPECT_TRUE(edits.nodes.empty());
  EXPECT_EQ(edits.light(0).move.x, 3);
  history.follow(edits, true);
  EXPECT_TRUE(history.can_redo()) << "undoing is no change of its own";
  EXPECT_TRUE(history.undo(edits));
  EXPECT_EQ(edits, stage::SceneEdits{}) << "the whole drag at once";
  EXPECT_FALSE(history.undo(edits));
  EXPECT_TRUE(history.redo(edits));
  EXPECT_TRUE(history.redo(edits));
  EXPECT_FALSE(edits.nodes[1].visible);
  EXPECT_FALSE(history.redo(edits));
  EXPECT_TRUE(history.undo(edits));
  edits.light(0).on = false;
  history.follow(edits, true);
  EXPECT_FALSE(history.can_redo()) << "another change is another way";
  for (int i = 0; i < 1000; ++i) {
    edits.light(0).move.y = static_cast<float>(i + 1);
    history.follow(edits, true);
  }
  std::size_t steps = 0;
  while (history.undo(edits)) ++steps;
  EXPECT_EQ(steps, UndoHistory::most_steps);
}

}  // namespace
}  // namespace tenebra::viewer
