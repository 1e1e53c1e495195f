// What the three BART scenes hold, against figures computed by an independent evaluator (aff-format.md, 8 and
// 9).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <tenebra/frame_geometry.h>
#include "formats/aff_bart.h"
#include "stage/left_out.h"

namespace tenebra::testing {
namespace {

/// Drawn triangles, and those of them that move.
struct Counts {
  std::size_t triangles = 0, moving = 0;
};

Counts count(const Scene& scene, bool cones) {
  Counts counts;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
    if (!cones && is_cone(mesh)) continue;
    counts.triangles += mesh.triangles.size();
    if (moves(scene, static_cast<int>(i))) counts.moving += mesh.triangles.size();
  }
  return counts;
}

TEST(AffBart, HoldsTheDocumentedTriangles) {
  const Counts robots = count(scene_of(Bart::robots), true);
  EXPECT_EQ(robots.triangles, 71'708u);
  EXPECT_EQ(robots.moving, 62'490u);
  const Counts kitchen = count(scene_of(Bart::kitchen), true);
  EXPECT_EQ(kitchen.triangles, 110'561u);
  EXPECT_EQ(kitchen.moving, 7'218u);
  const Counts museum = count(scene_of(Bart::museum), false);
  EXPECT_EQ(museum.triangles, 10'284u + 1'024u);
  EXPECT_EQ(museum.moving, 1'024u);
  EXPECT_EQ(count(scene_of(Bart::museum), true).triangles, 10'284u + 1'024u + 8 * 128u);
}

TEST(AffBart, EightSidedConesGiveThePapersCount) {
  const Expected<Scene> museum = formats::import_aff(bart / "museum/museum5.aff", {.cone_sides = 8});
  ASSERT_TRUE(museum.has_value()) << museum.error().message;
  EXPECT_EQ(count(*museum, true).triangles, 75'948u - 65'536u + 1'024u);
}

TEST(AffBart, HoldsTheDocumentedMeshesLightsAndTimes) {
  const Scene& robots = scene_of(Bart::robots);
  EXPECT_EQ(robots.meshes.size(), 1'849u);
  EXPECT_EQ(robots.lights.size(), 1u);
  EXPECT_EQ(robots.clips.at(0).frame_count, 800);
  EXPECT_DOUBLE_EQ(robots.clips[0].end_s, 50.0);
  EXPECT_NEAR(robots.cameras.at(0).vertical_fov_rad, glm::radians(36.869890479), 1e-6);
  EXPECT_NEAR(robots.cameras[0].near_m, 1.0, 1e-6);
  const Scene& kitchen = scene_of(Bart::kitchen);
  EXPECT_EQ(kitchen.meshes.size(), 393u);
  EXPECT_EQ(kitchen.lights.size(), 6u);
  EXPECT_EQ(kitchen.ambient_light, glm::vec3(2.5f));
  EXPECT_EQ(kitchen.background, glm::vec3(0.5f, 0.5f, 1.0f));
  EXPECT_NEAR(kitchen.cameras.at(0).near_m, 0.01, 1e-6);
  const Scene& museum = scene_of(Bart::museum);
  EXPECT_EQ(museum.clips.at(0).frame_count, 300);
  EXPECT_DOUBLE_EQ(museum.clips[0].start_s, -1.0);
  const std::vector<WorldLight> lights = evaluate_lights(museum, 0, 0.0);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].position, glm::vec3(-4, 4.5f, 0));
  EXPECT_EQ(museum.lights[0].color, glm::vec3(0.5f));
  EXPECT_EQ(museum.lights[0].falloff, Falloff::none);
}

/// Drawn triangles with two corners in the same place.
std::size_t coincident(const Scene& scene) {
  std::size_t count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    for (const glm::uvec3& t : mesh.triangles) {
      const auto &p = mesh.positions[t.x], &q = mesh.positions[t.y], &r = mesh.positions[t.z];
      count += p == q || q == r || r == p;
    }
  }
  return count;
}

TEST(AffBart, KeepsTheTrianglesWithCoincidentVertices) {
  EXPECT_EQ(coincident(scene_of(Bart::robots)), 128u);
  EXPECT_EQ(coincident(scene_of(Bart::kitchen)), 21u);
  EXPECT_EQ(coincident(scene_of(Bart::museum)), 0u);
}

struct Box {
  Bart scene;
  glm::dvec3 low, high;
};

TEST(AffBart, FillsTheDocumentedBoxOverAllFrames) {
  const Box boxes[] = {{Bart::robots, {-164.1, -0.6, -435.4}, {164.1, 535.4, 250.1}},
                       {Bart::kitchen, {-2, -1.1, -3.75}, {6, 2.9, 4.33}},
                       {Bart::museum, {-5, -1.07, -9.94}, {5, 5, 5}}};
  for (const Box& box : boxes) {
    SCOPED_TRACE(file_of(box.scene));
    const Scene& scene = scene_of(box.scene);
    const int frames = scene.clips.at(0).frame_count;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    FrameGeometry frame;
    for (int i = 0; i < frames; i += 20) {
      evaluate_frame(scene, 0, frame_time_s(scene.clips[0], i, 30.0), frame);
      for (const glm::uvec3& t : frame.triangles)
        for (int c = 0; c < 3; ++c) {
          low = glm::min(low, glm::dvec3(frame.positions[t[c]]));
          high = glm::max(high, glm::dvec3(frame.positions[t[c]]));
        }
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(low[k], box.low[k], 0.1);
      EXPECT_NEAR(high[k], box.high[k], 0.1);
    }
  }
}

TEST(AffBart, SkyCanBeLeftOut) {
  Scene robots = scene_of(Bart::robots);
  std::string unmatched;
  ASSERT_TRUE(stage::leave_out_casters(robots, {"city2.aff:69"}, unmatched)) << unmatched;
  EXPECT_NE(robots.warnings.back().find("2 triangles"), std::string::npos) << robots.warnings.back();
  FrameGeometry frame;
  evaluate_frame(robots, 0, 0.0, frame);
  const auto opaque = std::count(frame.casts_shadow.begin(), frame.casts_shadow.end(), 1);
  const auto see_through = std::count(frame.see_through.begin(), frame.see_through.end(), 1);
  EXPECT_EQ(opaque + see_through, 71'706);
  EXPECT_EQ(see_through, 1'514);  // and the sky's two
  EXPECT_FALSE(stage::leave_out_casters(robots, {"city2.aff:70"}, unmatched));
  EXPECT_EQ(unmatched, "city2.aff:70");
}

TEST(AffBart, Museum7NamesTheMissingFile) {
  const Expected<Scene> scene = formats::import_aff(bart / "museum/museum7.aff", {});
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("museum7.aff:"), std::string::npos) << scene.error().message;
  EXPECT_NE(scene.error().message.find("'animart7.aff'"), std::string::npos) << scene.error().message;
}

}  // namespace
}  // namespace tenebra::testing
