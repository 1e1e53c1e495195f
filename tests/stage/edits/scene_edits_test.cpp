// The user's changes to a scene: what they do to its lights, nodes and triangles.
#include "stage/edits/scene_edits.h"

#include <gtest/gtest.h>

namespace tenebra::stage {
namespace {

using glm::vec3;

TEST(LightEdits, ChangeTheirLightAndNoOther) {
  LightEdits edits(2);
  edits[0].on = false;
  edits[1] = {.intensity = 2, .move = {0, 1, 0}, .size_m = glm::vec2(6, 3)};
  std::vector<WorldLight> placed(3);
  for (int i = 0; i < 3; ++i) placed[static_cast<std::size_t>(i)].light = i;
  const auto moved = edited_lights(placed, edits, FileFrame{});
  ASSERT_EQ(moved.size(), 3u) << "numbers stay what they are";
  EXPECT_EQ(moved[1].position, vec3(0, 1, 0));
  EXPECT_EQ(moved[1].axis_x, vec3(3, 0, 0));
  EXPECT_EQ(moved[1].axis_y, vec3(0, 1.5f, 0));
  EXPECT_EQ(moved[2].position, vec3(0, 0, 0));
  const auto lights = edited_lights(std::vector<Light>(3), edits);
  EXPECT_EQ(lights[0].intensity, 0);
  EXPECT_EQ(lights[1].intensity, 2);
  EXPECT_EQ(lights[2].intensity, 1);
  EXPECT_EQ(edited_sizes_m(edits), (std::vector<std::optional<glm::vec2>>{std::nullopt, glm::vec2(6, 3)}));
}

TEST(SceneEdits, HideNodesWithAllBelowThem) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(
      {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}, .materials = {0}});
  scene.nodes = {{.mesh = 0}, {}, {.parent = 1, .mesh = 0}, {.parent = 2, .mesh = 0}, {.mesh = 0}};
  SceneEdits edits;
  edits.nodes[1].visible = false;
  edits.nodes[4].casts = false;
  FrameGeometry edited, baked;
  evaluate_frame(scene, -1, 0, edited);
  apply_node_edits(scene, edits, edited);
  EXPECT_EQ(edited.casts_shadow, (std::vector<std::uint8_t>{1, 1, 1, 0}));
  scene.nodes[1].visible = false;
  evaluate_frame(scene, -1, 0, baked);
  EXPECT_EQ(edited.triangles, baked.triangles);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    EXPECT_EQ(edited.pose.nodes[i].visible, baked.pose.nodes[i].visible) << i;
}

TEST(SceneEdits, TurnAreaLightsAsAWhole) {
  WorldLight light{.light = 0, .direction = {0, 0, -1}, .axis_x = {2, 0, 0}, .axis_y = {0, 1, 0}};
  for (const vec3 to : {vec3(0, -3, 0), vec3(0, 0, 5), vec3(1, 1, 1), vec3(0, 0, -1)}) {
    LightEdits edits(1);
    edits[0].direction = to;
    const WorldLight turned = edited_lights(std::vector{light}, edits, FileFrame{}).front();
    EXPECT_NEAR(glm::distance(turned.direction, glm::normalize(to)), 0, 1e-6);
    EXPECT_NEAR(glm::dot(turned.direction, turned.axis_x), 0, 1e-6);
    EXPECT_NEAR(glm::distance(glm::normalize(glm::cross(turned.axis_x, turned.axis_y)), -turned.direction), 0,
                1e-6);
    EXPECT_NEAR(glm::length(turned.axis_x), 2, 1e-6);
  }
}

}  // namespace
}  // namespace tenebra::stage
