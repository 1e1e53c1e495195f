// What a scene without camera and light gets, and which casters are left out of its shadows.
#include "stage/left_out.h"
#include "stage/additions.h"

#include <gtest/gtest.h>

#include <functional>

#include <tenebra/frame_geometry.h>

namespace tenebra::stage {
namespace {

Scene one_triangle() {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.name = "t";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  scene.meshes.push_back(mesh);
  Node node;
  node.mesh = 0;
  scene.nodes.push_back(node);
  return scene;
}

FrameGeometry frame_of(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  return frame;
}

TEST(Additions, CameraSeesAllAndLightIsThere) {
  Scene scene = one_triangle();
  scene.nodes[0].translation = {1e4, -2e4, 3e4};
  add_missing_camera_and_light(scene);
  ASSERT_EQ(scene.warnings.size(), 2u);
  const ViewRays view = evaluate_camera(scene, -1, 0, 0, 64, 64);
  const glm::dmat3 rays(view.dx, view.dy, view.d0);
  for (const glm::vec3& p : frame_of(scene).positions) {
    const glm::dvec3 pixel = glm::inverse(rays) * (glm::dvec3(p) - glm::dvec3(view.eye));
    EXPECT_GT(pixel.z, 0);
    EXPECT_TRUE(pixel.x > 0 && pixel.x < 64 * pixel.z && pixel.y > 0 && pixel.y < 64 * pixel.z);
  }
  EXPECT_EQ(evaluate_lights(scene, -1, 0).size(), 1u);
  add_missing_camera_and_light(scene);
  EXPECT_EQ(scene.warnings.size(), 2u);
  Scene empty;
  add_missing_camera_and_light(empty);
  EXPECT_EQ(empty.cameras.size(), 1u);
}

TEST(Additions, CameraSeesWhatMovesThroughTheWholeClip) {
  Scene scene = one_triangle();
  Clip clip{.name = "away", .start_s = 0, .end_s = 4};
  clip.tracks.push_back({.components = 3, .times_s = {0, 4}, .values = {0, 0, 0, 50, 20, 0}});
  clip.channels.push_back({.node = 0, .path = ChannelPath::translation, .track = 0});
  scene.clips.push_back(clip);
  add_missing_camera_and_light(scene);
  const ViewRays view = evaluate_camera(scene, 0, 0, 0, 64, 64);
  for (const double time_s : {0.0, 2.0, 4.0}) {
    FrameGeometry frame;
    evaluate_frame(scene, 0, time_s, frame);
    for (const glm::vec3& p : frame.positions) {
      const glm::dvec3 pixel =
          glm::inverse(glm::dmat3(view.dx, view.dy, view.d0)) * (glm::dvec3(p) - glm::dvec3(view.eye));
      EXPECT_TRUE(pixel.x > 0 && pixel.x < 64 * pixel.z && pixel.y > 0 && pixel.y < 64 * pixel.z) << time_s;
    }
  }
}

TEST(Casters, AreLeftOutByMeshOrMaterialOrSource) {
  for (const std::string name : {"t", "paint", "a.aff:3"}) {
    Scene scene = one_triangle();
    scene.materials[0].name = "paint";
    scene.meshes[0].source = "a.aff:3";
    scene.nodes.push_back(scene.nodes[0]);
    std::string unmatched;
    EXPECT_TRUE(leave_out_casters(scene, {name}, unmatched));
    EXPECT_NE(scene.warnings.at(0).find("2 triangles"), std::string::npos);
    EXPECT_EQ(frame_of(scene).casts_shadow, (std::vector<std::uint8_t>{0, 0}));
    EXPECT_FALSE(leave_out_casters(scene, {name, "nothing"}, unmatched));
    EXPECT_EQ(unmatched, "nothing");
  }
}

/// A floor, a roof of the same size above it that looks down, called a sky, and a light above both.
Scene covered_floor() {
  Scene scene;
  scene.materials.resize(1);
  const auto add_square = [&](float y, float half, bool up) {
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = up ? "floor" : "Skydome";
    mesh.positions = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    if (!up) mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    scene.nodes.push_back({.mesh = static_cast<int>(scene.meshes.size()) - 1});
  };
  add_square(0, 5, true);
  add_square(8, 5, false);
  scene.lights.emplace_back().name = "lamp";
  scene.nodes.push_back({.translation = {0, 20, 0}, .light = 0});
  return scene;
}

TEST(Covers, SkyIsLeftOutOfTheCastersOfTheLightItHides) {
  Scene scene = covered_floor();
  leave_out_covers(scene);
  EXPECT_EQ(scene.lights[0].left_out_nodes, std::vector<int>{1});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("Skydome hides light 0 (lamp)"), std::string::npos) << scene.warnings[0];
}

// A ceiling of one sheet keeps the light of the lamp above it out; what is painted as a sky does not.
TEST(Covers, WhatDoesNotLookLikeASkyIsACeiling) {
  Scene ceiling = covered_floor();
  ceiling.meshes[1].name = "ceiling";
  leave_out_covers(ceiling);
  EXPECT_TRUE(ceiling.lights[0].left_out_nodes.empty());
  EXPECT_NE(ceiling.warnings.at(0).find("ceiling hides light 0 (lamp)"), std::string::npos);
  const auto is_left_out = [&](const std::function<void(Scene&)>& paint) {
    Scene scene = covered_floor();
    scene.meshes[1].name.clear();
    scene.meshes[1].materials = {1, 1};
    scene.materials.resize(2);
    paint(scene);
    leave_out_covers(scene);
    return !scene.lights[0].left_out_nodes.empty();
  };
  EXPECT_FALSE(is_left_out([](Scene&) {}));
  EXPECT_TRUE(is_left_out([](Scene& scene) { scene.nodes[1].name = "the SKY"; }));
  EXPECT_TRUE(is_left_out([](Scene& scene) { scene.materials[1].name = "sky.001"; }));
  EXPECT_TRUE(is_left_out([](Scene& scene) { scene.materials[1].model = SurfaceModel::unlit; }));
  EXPECT_TRUE(is_left_out([](Scene& scene) { scene.materials[1].emissive = {0, 0, 1}; }));
  EXPECT_TRUE(is_left_out([](Scene& scene) { scene.transfer = Transfer::display; })) << "a file of AFF";
}

TEST(Covers, WhatHidesALittleLessIsNone) {
  Scene small = covered_floor();
  for (glm::vec3& p : small.meshes[1].positions) p *= glm::vec3(0.59f, 1, 0.59f);  // 0.6 would do
  leave_out_covers(small);
  EXPECT_TRUE(small.lights[0].left_out_nodes.empty());
  Scene beside = covered_floor();
  beside.nodes[2].translation = {40, 20, 0};
  leave_out_covers(beside);
  EXPECT_TRUE(beside.lights[0].left_out_nodes.empty());
  Scene below = covered_floor();
  below.nodes[2].translation = {0, 4, 0};
  leave_out_covers(below);
  EXPECT_TRUE(below.lights[0].left_out_nodes.empty());
}

TEST(Covers, WhatFacesAwayIsClosedOrAmongTheOthersIsNone) {
  Scene away = covered_floor();
  away.meshes[1].triangles = {{0, 2, 1}, {0, 3, 2}};
  leave_out_covers(away);
  EXPECT_TRUE(away.lights[0].left_out_nodes.empty());
  ASSERT_EQ(away.warnings.size(), 1u);
  EXPECT_NE(away.warnings[0].find("Skydome hides light 0 (lamp)"), std::string::npos) << away.warnings[0];
  EXPECT_NE(away.warnings[0].find("--no-cast"), std::string::npos) << away.warnings[0];
  Scene closed = covered_floor();
  closed.meshes[1].triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};  // a plate with two sides
  closed.meshes[1].materials.resize(4, 0);
  leave_out_covers(closed);
  EXPECT_TRUE(closed.lights[0].left_out_nodes.empty());
  Scene among = covered_floor();
  among.nodes.push_back({.translation = {0, 9, 0}, .scale = {0.5, 1, 0.5}, .mesh = 0});
  leave_out_covers(among);
  EXPECT_TRUE(among.lights[0].left_out_nodes.empty());
}

TEST(Covers, SunIsHiddenByWhatIsAsLargeAsTheScene) {
  Scene scene = covered_floor();
  scene.lights[0].type = LightType::directional;
  scene.nodes[2].rotation = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));  // straight down
  for (glm::vec3& p : scene.meshes[1].positions) p *= glm::vec3(1.01f, 1, 1.01f);
  leave_out_covers(scene);
  EXPECT_EQ(scene.lights[0].left_out_nodes, std::vector<int>{1});
}

}  // namespace
}  // namespace tenebra::stage
