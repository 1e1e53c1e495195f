// One instant of small scenes: hierarchies, mirrors, skins, morph targets, lights, cameras, and their
// extremes.
#include <tenebra/frame_geometry.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace tenebra {
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

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance = 1e-6f) {
  EXPECT_LE(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Frame, MirrorsFlipTheWindingAndTurnNormals) {
  Scene scene = one_triangle();
  scene.nodes[0].scale = {-2, 1, 1};
  const FrameGeometry frame = frame_of(scene);
  EXPECT_EQ(frame.triangles[0], glm::uvec3(0, 2, 1));
  const glm::vec3 a = frame.positions[0], b = frame.positions[2], c = frame.positions[1];
  EXPECT_GT(glm::cross(b - a, c - a).z, 0);
  expect_near(frame.normals[0], {0, 0, 1});
}

TEST(Frame, TangentsFollowTheSurfaceAndMirrorsTurnTheirSide) {
  Scene scene = one_triangle();
  EXPECT_TRUE(frame_of(scene).tangents.empty());
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes[1].mesh = 1;
  scene.meshes.push_back(scene.meshes[0]);  // without tangents beside one that has them
  Mesh& mesh = scene.meshes[0];
  mesh.tangents.assign(3, {glm::normalize(glm::vec3(1, 1, 0)), 1});
  scene.nodes[0].scale = {-4, 3, 1};
  const FrameGeometry mirrored = frame_of(scene);
  ASSERT_EQ(mirrored.tangents.size(), 6u);
  expect_near(mirrored.tangents[0], {-0.8f, 0.6f, 0});
  EXPECT_EQ(mirrored.tangents[0].w, -1.0f);
  EXPECT_EQ(mirrored.tangents[3], glm::vec4(0));
  scene.nodes[0].scale = {1, 1, 1};
  mesh.morph_targets.resize(1);
  mesh.morph_targets[0].tangents.assign(3, {0, 0, std::sqrt(0.5f)});
  mesh.default_weights = {2};
  expect_near(frame_of(scene).tangents[1], glm::normalize(glm::vec3(1, 1, 2)));
  mesh.joints.assign(3, glm::u16vec4(0));
  mesh.weights.assign(3, {1, 0, 0, 0});
  scene.nodes[0].skin = 0;
  scene.nodes[1].rotation = glm::angleAxis(std::acos(-1.0) / 2, glm::dvec3(0, 0, 1));
  scene.skins.push_back({{1}, {}});
  expect_near(frame_of(scene).tangents[1], glm::normalize(glm::vec3(-1, 1, 2)));
}

TEST(Frame, NormalsFollowTheInverseTranspose) {
  Scene scene = one_triangle();
  scene.meshes[0].normals.assign(3, glm::normalize(glm::vec3(1, 1, 0)));
  scene.nodes[0].scale = {4, 1, 1};
  expect_near(frame_of(scene).normals[0], glm::normalize(glm::vec3(0.25f, 1, 0)));
  scene.nodes[0].scale = {1, 1, 0};  // flat: the normal of the plane, or none
  scene.meshes[0].normals.assign(3, {0, 0.6f, 0.8f});
  expect_near(frame_of(scene).normals[0], {0, 0, 1});
  scene.nodes[0].scale = {0, 0, 0};
  EXPECT_TRUE(std::isfinite(frame_of(scene).normals[0].x));
}

TEST(Frame, HiddenSubtreesKeepTheirTriangleIds) {
  Scene scene = one_triangle();
  Node child;
  child.parent = 0;
  child.mesh = 0;
  scene.nodes.push_back(child);
  child.parent = -1;
  scene.nodes.push_back(child);
  scene.nodes[0].visible = false;
  const FrameGeometry frame = frame_of(scene);
  EXPECT_EQ(frame.triangles, (std::vector<glm::uvec3>{{0, 0, 0}, {0, 0, 0}, {6, 7, 8}}));
  EXPECT_EQ(frame.dropped_non_finite, 0u);
}

TEST(Frame, VerticesOutOfRangeDropTheirTriangles) {
  for (const float bad : {NAN, INFINITY, -INFINITY, 1.9e18f, std::numeric_limits<float>::max()}) {
    Scene scene = one_triangle();
    scene.meshes[0].positions.push_back({1, 1, 1});
    scene.meshes[0].normals.push_back({0, 0, 1});
    scene.meshes[0].triangles.push_back({3, 1, 2});
    scene.meshes[0].materials.push_back(0);
    scene.meshes[0].positions[0].z = bad;
    const FrameGeometry frame = frame_of(scene);
    EXPECT_EQ(frame.triangles, (std::vector<glm::uvec3>{{0, 0, 0}, {3, 1, 2}}));
    EXPECT_EQ(frame.dropped_non_finite, 1u);
    EXPECT_EQ(frame.positions[0], glm::vec3(0.0f));
  }
  Scene scene = one_triangle();
  scene.meshes[0].positions[0].z = 1.8e18f;
  EXPECT_EQ(frame_of(scene).dropped_non_finite, 0u);
}

TEST(Frame, RoundsOnceFromDouble) {
  Scene scene = one_triangle();
  scene.nodes[0].translation = {-1e9, 0, 0};  // in float the parent's offset would eat the quarter
  Node child = scene.nodes[0];
  child.parent = 0;
  child.translation = {1e9 + 0.25, 0, 0};
  scene.nodes.push_back(child);
  EXPECT_EQ(frame_of(scene).positions[3], glm::vec3(0.25f, 0, 0));
}

TEST(Frame, DeepAndWideHierarchiesTakeLinearTime) {
  Scene scene = one_triangle();
  scene.nodes[0].mesh = -1;
  for (int i = 1; i < 100'000; ++i) {
    Node node;
    node.parent = i < 10'000 ? i - 1 : 9'999;
    node.translation = {0, i < 10'000 ? 1.0 : 0.0, 0};
    node.mesh = i % 2 ? 0 : -1;
    scene.nodes.push_back(node);
  }
  const auto start = std::chrono::steady_clock::now();
  const FrameGeometry frame = frame_of(scene);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_EQ(frame.positions.back(), glm::vec3(0, 10'000, 0));
}

TEST(Frame, ReusesItsBuffers) {
  const Scene scene = one_triangle();
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  const void* before[] = {frame.positions.data(), frame.triangles.data(), frame.pose.nodes.data()};
  evaluate_frame(scene, -1, 1, frame);
  const void* after[] = {frame.positions.data(), frame.triangles.data(), frame.pose.nodes.data()};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(before[i], after[i]);
}

TEST(Frame, MorphTargetsAddUp) {
  Scene scene = one_triangle();
  scene.meshes[0].morph_targets = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}},
                                   {{{0, 2, 0}, {0, 2, 0}, {0, 2, 0}}, {}}};
  scene.meshes[0].default_weights = {0.5f, 0.25f};
  EXPECT_EQ(frame_of(scene).positions[1], glm::vec3(1, 0.5f, 0.5f));
  scene.nodes[0].weights = {-1.0f, 0.0f};
  EXPECT_EQ(frame_of(scene).positions[1], glm::vec3(1, 0, -1));
  Clip clip;
  clip.tracks.push_back({.components = 2, .times_s = {0, 1}, .values = {0, 0, 2, 4}, .tcb = {}});
  clip.channels.push_back({0, ChannelPath::weights, 0});
  scene.clips.push_back(clip);
  FrameGeometry frame;
  evaluate_frame(scene, 0, 0.5, frame);
  EXPECT_EQ(frame.positions[0], glm::vec3(0, 4, 1));
}

TEST(Frame, SkinsIgnoreTheNodeOfTheMesh) {
  Scene scene = one_triangle();
  scene.nodes[0].translation = {100, 0, 0};
  scene.nodes[0].skin = 0;
  Node joint;
  joint.translation = {0, 0, 2};
  scene.nodes.push_back(joint);
  joint.translation = {0, 0, 6};
  scene.nodes.push_back(joint);
  scene.skins.push_back({{1, 2}, {glm::mat4(1.0f), glm::mat4(1.0f)}});
  scene.meshes[0].joints.assign(3, {0, 1, 0, 0});
  scene.meshes[0].weights = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}};
  const FrameGeometry frame = frame_of(scene);
  EXPECT_EQ(frame.positions, (std::vector<glm::vec3>{{0, 0, 2}, {1, 0, 6}, {0, 1, 4}}));
  expect_near(frame.normals[2], {0, 0, 1});
}

TEST(Lights, StandAndShineAsTheirNodeDoes) {
  Scene scene;
  scene.lights.resize(1);
  scene.lights[0].type = LightType::area_rect;
  scene.lights[0].size_m = {2, 4};
  Node node;
  node.light = 0;
  node.translation = {1, 2, 3};
  node.rotation = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));
  scene.nodes.push_back(node);
  const std::vector<WorldLight> lights = evaluate_lights(scene, -1, 0);
  ASSERT_EQ(lights.size(), 1u);
  expect_near(lights[0].position, {1, 2, 3});
  expect_near(lights[0].direction, {0, -1, 0});
  expect_near(lights[0].axis_x, {1, 0, 0});
  expect_near(lights[0].axis_y, {0, 0, -2});
  scene.nodes[0].translation.x = NAN;
  EXPECT_TRUE(evaluate_lights(scene, -1, 0).empty());
}

TEST(View, SurvivesExtremes) {
  const float big = std::numeric_limits<float>::max();
  const glm::vec3 vectors[] = {{0, 0, 0},      {0, 1, 0},        {0, -1, 0}, {0, 0, 1},
                               {1e-38f, 0, 0}, {big, -big, big}, {NAN, 0, 0}};
  for (const glm::vec3& target : vectors) {
    for (const glm::vec3& up : vectors) {
      for (const float fov : {0.0f, 1e-5f, 1.0f, 3.14159274f, -1.0f}) {
        const ViewRays v = look_at({0, 0, 0}, target, up, fov, 0.1f, 16, 9);
        for (const glm::vec3& x : {v.d0, v.dx, v.dy}) ASSERT_TRUE(std::isfinite(x.x + x.y + x.z));
        ASSERT_GT(glm::length(v.dx), 0.0f);
        ASSERT_NEAR(glm::dot(glm::normalize(v.dx), glm::normalize(v.dy)), 0.0f, 1e-5f);
      }
    }
  }
  const ViewRays down = look_at({0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1.0f, 0.1f, 2, 2);
  expect_near(down.d0 + down.dx + down.dy, {0, -1, 0});
}

TEST(View, IgnoresTheScaleOfTheCamera) {
  Scene scene;
  scene.cameras.resize(1);
  Node node;
  node.camera = 0;
  scene.nodes.push_back(node);
  const ViewRays plain = evaluate_camera(scene, -1, 0, 0, 8, 6);
  scene.nodes[0].scale = {-3, 2, 5};
  const ViewRays scaled = evaluate_camera(scene, -1, 0, 0, 8, 6);
  expect_near(plain.d0, scaled.d0);
  expect_near(plain.dx, scaled.dx);
  expect_near(plain.dy, scaled.dy);
}

TEST(View, OrthographicRaysStartAtTheCorner) {
  Scene scene;
  scene.cameras.resize(1);
  scene.cameras[0].projection = Projection::orthographic;
  scene.cameras[0].vertical_extent_m = 4;
  Node node;
  node.camera = 0;
  scene.nodes.push_back(node);
  const ViewRays v = evaluate_camera(scene, -1, 0, 0, 4, 2);
  expect_near(v.eye, {-4, 2, 0});
  expect_near(v.dx, {2, 0, 0});
  expect_near(v.dy, {0, -2, 0});
  expect_near(v.d0, {0, 0, -1});
}

}  // namespace
}  // namespace tenebra
