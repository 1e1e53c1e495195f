// Parts that are added to scenes that lack them: the camera shows the subject and its shadow, the floor lies
// under it, the sun shines from the side.
#include "stage/additions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include <tenebra/frame_geometry.h>
#include "stage/box_scenes.h"
#include "stage/default_light.h"

namespace tenebra::stage {
namespace {

using glm::dvec3;
using namespace testing;  // NOLINT(google-build-using-namespace): box_scenes.h

Scene box(glm::vec3 low = glm::vec3(-1), glm::vec3 high = glm::vec3(1)) {
  return boxes({{low, high}});
}

struct Shape {
  const char* name;
  Scene scene;
};
std::vector<Shape> shapes() {
  std::vector<Shape> all{{"cube", box()},
                         {"tiny, far away", box({1e4, 50, -2e4}, {1e4 + 1, 51, -2e4 + 1})},
                         {"slab", box({-2, 0, -1}, {2, 0.5f, 1})},
                         {"tower", box({-0.6f, 0, -0.5f}, {0.6f, 3, 0.5f})},
                         {"wall", box({-2, 0, 0}, {2, 2, 0.1f})},
                         {"two", boxes({{{-1, 0, -1}, {0, 1, 0}}, {{0.2f, 0, 0.2f}, {1, 1.5f, 1}}})}};
  return all;
}

TEST(AddedCamera, FillsThreeTenthsOfThePictureAndShowsTheShadow) {
  for (Shape& shape : shapes()) {
    const std::size_t subject = frame_at(shape.scene).triangles.size();
    const AddedParts added = add_missing_parts(shape.scene);
    EXPECT_TRUE(added.camera && added.light && added.floor) << shape.name;
    EXPECT_EQ(shape.scene.warnings.size(), 3u);
    const FrameGeometry frame = frame_at(shape.scene);
    EXPECT_EQ(frame.triangles.size(), subject + 62 + 128);  // the disc, and its rim
    expect_in_picture(shape.scene, frame, subject);
    const BoxShares shares = shares_of(shape.scene, frame, subject);
    EXPECT_GE(shares.subject, 0.3) << shape.name;
    EXPECT_GE(shares.shadow, 0.015) << shape.name;
  }
}

TEST(AddedCamera, SeesWhatMovesThroughTheWholeClip) {
  Scene scene = box();
  Clip clip{.name = "away", .start_s = 0, .end_s = 4};
  clip.tracks.push_back({.components = 3, .times_s = {0, 4}, .values = {0, 0, 0, 50, 20, 0}});
  clip.channels.push_back({.node = 0, .path = ChannelPath::translation, .track = 0});
  scene.clips.push_back(clip);
  const std::size_t subject = frame_at(scene).triangles.size();
  add_missing_parts(scene);
  for (const double time_s : {0.0, 2.0, 4.0}) expect_in_picture(scene, frame_at(scene, time_s), subject);
}

/// Each triangle as 4^times.
void split(Mesh& mesh, int times) {
  for (int i = 0; i < times; ++i) {
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& t : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      const glm::uvec3 middles(first, first + 1, first + 2);
      for (int k = 0; k < 3; ++k)
        mesh.positions.push_back(0.5f * (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]));
      triangles.insert(
          triangles.end(),
          {{t.x, middles.x, middles.z}, {t.y, middles.y, middles.x}, {t.z, middles.z, middles.y}, middles});
    }
    mesh.triangles = std::move(triangles);
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
}

// Many small triangles are measured by the cells that hold them: a little too large.
TEST(AddedCamera, FillsThePictureAsMuchHoweverFineTheTrianglesAre) {
  for (Shape& shape : shapes()) {
    const FrameGeometry subject = frame_at(shape.scene);
    Scene fine = shape.scene;
    for (Mesh& mesh : fine.meshes) split(mesh, 7);
    ASSERT_GT(frame_at(fine).triangles.size(), 100000u);
    add_missing_parts(shape.scene);
    add_missing_parts(fine);
    fine.meshes = shape.scene.meshes;  // seen by its own camera
    const FrameGeometry frame = frame_at(fine);
    expect_in_picture(fine, frame, subject.triangles.size());
    const BoxShares shares = shares_of(fine, frame, subject.triangles.size());
    EXPECT_GE(shares.subject, 0.27) << shape.name;
    EXPECT_GE(shares.shadow, 0.015) << shape.name;
  }
}

TEST(AddedCamera, TakesTheShapeThatIsAskedFor) {
  Scene scene = box({-3, 0, -0.2f}, {3, 0.5f, 0.2f});
  add_missing_parts(scene, {.floor = true, .aspect = 2.5f});
  EXPECT_FALSE(scene.cameras[0].aspect);
  scene.cameras[0].aspect = 2.5f;
  expect_in_picture(scene, frame_at(scene), 12);
}

TEST(AddedCamera, StandsWhereItsSentenceSays) {
  for (const double step : {0.0, 5334567.25}) {
    Scene scene = box({0, 0, 0}, {1, 1, 1});
    scene.frame.origin = {step, 0, 0};
    add_missing_parts(scene, {.up_assumed = true});
    const auto camera = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                     [](const Node& node) { return node.camera >= 0; });
    const dvec3 eye = scene.frame.to_file(camera->translation);
    std::string said;
    dvec3 found(0);
    for (const std::string& text : scene.warnings)
      if (text.starts_with("The scene has no camera; one was added at ")) said = text.substr(42);
    ASSERT_EQ(std::sscanf(said.c_str(), "%lf,%lf,%lf", &found.x, &found.y, &found.z), 3) << said;
    EXPECT_LT(glm::distance(found, eye), 1e-3);
    EXPECT_NE(said.find("with Y up (--up-axis z"), std::string::npos) << said;
  }
}

TEST(AddedFloor, HasAHeightWithoutAnExponent) {
  Scene scene = box({0, 0, 0}, {1, 1, 1});
  scene.frame.origin = {0, 5334567, 0};
  add_missing_parts(scene);
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), [](const std::string& text) {
    return text.find("at a height of 5334566.99") != std::string::npos;
  }));
}

TEST(AddedSun, ShinesFromTheLeftBehindTheCameraWhicheverCameraItIs) {
  for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
    Scene scene = box();
    scene.cameras.emplace_back();
    Node node;
    node.camera = 0;
    node.translation = 6.0 * dvec3(std::sin(turn), 0.4, std::cos(turn));
    node.rotation = glm::angleAxis(turn, dvec3(0, 1, 0));
    scene.nodes.push_back(node);
    const AddedParts added = add_missing_parts(scene);
    EXPECT_FALSE(added.camera);
    const ViewRays view = evaluate_camera(scene, -1, 0, 0, 8, 8);
    const auto lights = evaluate_lights(scene, -1, 0);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    const dvec3 to_sun = -dvec3(lights[0].direction);
    const dvec3 right = glm::normalize(dvec3(view.dx)), back(std::sin(turn), 0, std::cos(turn));
    const double degree = std::acos(-1.0) / 180;
    EXPECT_NEAR(to_sun.y, std::sin(50 * degree), 1e-6);
    EXPECT_NEAR(glm::dot(to_sun, right), -std::cos(50 * degree) * std::sin(60 * degree), 1e-6);
    EXPECT_NEAR(glm::dot(to_sun, back), std::cos(50 * degree) * std::cos(60 * degree), 1e-6);
  }
}

/// Whether there is an added floor, with the light that belongs to it.
bool gets_floor(Scene scene, const Additions& wish = {}) {
  const std::size_t before = scene.meshes.size();
  const AddedParts added = add_missing_parts(scene, wish);
  EXPECT_EQ(scene.meshes.size(), before + (added.floor ? 1 : 0));
  return added.floor;
}

TEST(AddedFloor, IsOnlyWhereLightAndFloorAreMissing) {
  EXPECT_TRUE(gets_floor(box()));
  EXPECT_FALSE(gets_floor(box(), {.floor = false, .aspect = {}}));
  EXPECT_FALSE(gets_floor(Scene{}));
  EXPECT_FALSE(gets_floor(boxes({{{-1, 0, -1}, {1, 1, 1}}, {{-9, -0.1f, -9}, {9, 0, 9}}})));
  // As large as the subject alone: its shadow falls beside.
  EXPECT_TRUE(gets_floor(boxes({{{-1, 0, -1}, {1, 2, 1}}, {{-1, -0.1f, -1}, {1, 0, 1}}})));
  Scene lit = box();
  lit.lights.emplace_back();
  Node node;
  node.light = 0;
  lit.nodes.push_back(node);
  EXPECT_FALSE(gets_floor(lit));
  EXPECT_EQ(lit.ambient_light, Scene{}.ambient_light);
}

TEST(AddedFloor, LiesUnderAllAndHoldsTheShadow) {
  Scene scene = box({3, -7, 2}, {4, -5, 5});
  add_missing_parts(scene);
  const FrameGeometry frame = frame_at(scene);
  glm::vec3 low(1e9f), high(-1e9f);
  for (std::size_t i = 12; i < frame.triangles.size(); ++i) {
    EXPECT_FALSE(frame.casts_shadow[i]);
    EXPECT_EQ(frame.see_through[i], scene.materials[frame.materials[i]].see_through() ? 2 : 0);
    const glm::uvec3 t = frame.triangles[i];
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, frame.positions[t[k]]);
      high = glm::max(high, frame.positions[t[k]]);
    }
    EXPECT_GT(
        glm::cross(frame.positions[t.y] - frame.positions[t.x], frame.positions[t.z] - frame.positions[t.x])
            .y,
        0);
  }
  EXPECT_EQ(low.y, high.y);
  EXPECT_LT(low.y, -7);
  EXPECT_GT(low.y, -7.01f);
  const glm::vec3 along = evaluate_lights(scene, -1, 0)[0].direction;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner = frame.positions[static_cast<std::size_t>(i)];
    const glm::vec3 shadow = corner + (low.y - corner.y) / along.y * along;
    EXPECT_TRUE(shadow.x > low.x && shadow.x < high.x && shadow.z > low.z && shadow.z < high.z);
  }
}

// The opaque part, which comes first, reaches beyond the shadow of a sun 30 degrees high from any side.
TEST(AddedFloor, FadesOutBeyondTheShadowOfALowSun) {
  Scene scene = box({-2, 0, -1}, {2, 5, 1});
  add_missing_parts(scene);
  const Mesh& floor = scene.meshes.back();
  ASSERT_EQ(floor.texture_coordinates[0].size(), floor.positions.size());
  const TextureImage& fade = scene.images.at(0);
  for (std::size_t i = 0; i < floor.positions.size(); ++i) {
    const glm::vec3& p = floor.positions[i];
    const bool inner = floor.texture_coordinates[0][i].x == 0;
    const double reach = std::hypot(2, 1) + 5 / std::tan(std::acos(-1.0) / 6);
    EXPECT_EQ(std::hypot(p.x, p.z) < 1.5 * reach, inner);
    EXPECT_GT(std::hypot(p.x, p.z), reach);
  }
  EXPECT_EQ(fade.rgba[3], 255);
  EXPECT_EQ(fade.rgba.back(), 0);
}

TEST(AddedFloor, IsNotSeenFromBelow) {
  Scene scene = box();
  const AddedParts added = add_missing_parts(scene);
  FrameGeometry frame = frame_at(scene);
  const auto drawn = [&] {
    return frame.triangles.size() - std::count(frame.triangles.begin(), frame.triangles.end(), glm::uvec3(0));
  };
  const auto all = drawn();
  hide_floor_from_below(added, added.floor_y + 0.01, frame);
  EXPECT_EQ(drawn(), all);
  hide_floor_from_below(added, added.floor_y - 0.01, frame);
  EXPECT_EQ(drawn(), 12u);
}

TEST(AddedParts, AreTakenOutAgain) {
  for (const Scene& scene : {box(), scene_of({})}) {
    Scene lit = scene;
    const AddedParts added = add_missing_parts(lit, {.for_pictures = false});
    EXPECT_TRUE(added.light && !added.floor);
    Scene pictured = scene;
    add_missing_parts(pictured);
    EXPECT_EQ(evaluate_lights(lit, -1, 0)[0].direction, evaluate_lights(pictured, -1, 0)[0].direction);
    remove_added(added, lit);
    EXPECT_EQ(lit.nodes.size(), scene.nodes.size());
    EXPECT_TRUE(lit.lights.empty() && lit.cameras.empty());
    EXPECT_EQ(lit.ambient_light, scene.ambient_light);
    EXPECT_EQ(lit.background, scene.background);
  }
}

TEST(AddedSun, IsAddedAsTheSkyIsWanted) {
  const auto lights = [](Sky sky) {
    Scene scene = box();
    scene.lights.emplace_back();
    scene.nodes.push_back({.light = 0});
    add_missing_parts(scene, {.sky = sky});
    return scene.lights.size();
  };
  EXPECT_EQ(lights(Sky::automatic), 1u);
  EXPECT_EQ(lights(Sky::sun), 2u);
  Scene dark = box();
  EXPECT_FALSE(add_missing_parts(dark, {.sky = Sky::none}).light);
  EXPECT_TRUE(dark.lights.empty());
}

TEST(AddedFloor, InTheSunIsAsBrightAsTheBackground) {
  Scene scene = box();
  add_missing_parts(scene);
  const double sun = -evaluate_lights(scene, -1, 0)[0].direction.y * scene.lights[0].intensity;
  const Material& floor = scene.materials.back();
  EXPECT_NEAR(floor.base_color.x * (sun + scene.ambient_light.x), scene.background.x, 1e-6);
  Scene coloured = box();
  coloured.background = {0.1f, 0.2f, 0.6f};
  add_missing_parts(coloured);
  EXPECT_EQ(coloured.background, glm::vec3(0.1f, 0.2f, 0.6f)) << "a background that the file states stays";
}

TEST(SoftSky, LightsWhatFacesUpByTheAmbientLight) {
  const io::ImageF sky = soft_sky();
  double sum = 0, weights = 0;
  const double pi = std::acos(-1.0);
  for (int row = 0; row < sky.height / 2; ++row) {
    const double top = std::cos(pi * row / sky.height), bottom = std::cos(pi * (row + 1) / sky.height);
    const double weight = top * top - bottom * bottom;  // of cosine times solid angle
    sum += weight * sky.pixels[static_cast<std::size_t>(3 * sky.width * row)];
    weights += weight;
  }
  EXPECT_NEAR(sum / weights, default_ambient, 1e-3);
  EXPECT_EQ(sky.pixels.back(), default_horizon);
}

TEST(Additions, NothingIsAddedTwice) {
  Scene scene = box();
  add_missing_parts(scene);
  const std::size_t nodes = scene.nodes.size();
  const AddedParts again = add_missing_parts(scene);
  EXPECT_FALSE(again.camera || again.light || again.floor);
  EXPECT_EQ(scene.nodes.size(), nodes);
  EXPECT_EQ(scene.warnings.size(), 3u);
}

}  // namespace
}  // namespace tenebra::stage
