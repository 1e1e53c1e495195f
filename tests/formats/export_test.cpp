// export_glb against the importer: shapes, lights, flags and shared scenes come back.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <tenebra/frame_geometry.h>
#include "formats/import_scene.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const std::string& name) {
  return fs::temp_directory_path() / fmt::format("tenebra_{}_{}", getpid(), name);
}

/// Sorted coordinates of all corners on one axis: equal within a tolerance whatever the order of triangles.
std::vector<float> corners(const FrameGeometry& geometry, int axis) {
  std::vector<float> values;
  for (const auto& t : geometry.triangles)
    for (int c = 0; c < 3; ++c) values.push_back(geometry.positions[t[c]][axis]);
  std::sort(values.begin(), values.end());
  return values;
}

void expect_same_geometry(const Scene& a, const Scene& b, int clip, double time_s, float relative) {
  FrameGeometry ga, gb;
  evaluate_frame(a, clip, time_s, ga);
  evaluate_frame(b, clip, time_s, gb);
  for (int axis = 0; axis < 3; ++axis) {
    const auto va = corners(ga, axis), vb = corners(gb, axis);
    ASSERT_EQ(va.size(), vb.size());
    const float extent = va.empty() ? 1 : std::max(std::abs(va.front()), std::abs(va.back()));
    for (std::size_t i = 0; i < va.size(); ++i)
      ASSERT_NEAR(va[i], vb[i], relative * extent) << "axis " << axis;
  }
}

/// A square of two triangles whose shape changes, under a node with a Kochanek-Bartels track.
Scene shaped_scene() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].casts_shadow = false;
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0, 1};
  for (int k = 0; k < 3; ++k) {
    Mesh::Shape shape{1.0 * k, mesh.positions, {}};
    for (auto& p : shape.positions) p *= 1.0f + static_cast<float>(k * k);
    mesh.shapes.push_back(shape);
  }
  scene.meshes.push_back(mesh);
  Node node;
  node.mesh = 0;
  scene.nodes.push_back(node);
  Clip clip;
  clip.end_s = 2;
  clip.frame_count = 21;
  Track track{Interpolation::linear, 3, {0, 1, 2}, {0, 0, 0, 4, 1, 0, 0, 9, 2}, {}};
  clip.tracks.push_back(track);
  clip.channels.push_back({0, ChannelPath::translation, 0});
  scene.clips.push_back(clip);
  Light sun;
  sun.type = LightType::directional;
  Light panel;
  panel.type = LightType::area_rect;
  panel.size_m = {3, 2};
  scene.lights = {sun, panel};
  for (int l = 0; l < 2; ++l) {
    scene.nodes.emplace_back();
    scene.nodes.back().light = l;
  }
  return scene;
}

TEST(ExportGlb, ShapesLightsAndShadowFlagsComeBack) {
  const fs::path path = scratch("shapes.glb");
  const Scene scene = shaped_scene();
  ASSERT_TRUE(formats::export_glb(scene, path).has_value());
  const auto back = formats::import_gltf(path);
  fs::remove(path);
  ASSERT_TRUE(back.has_value()) << back.error().message;
  for (const double time : {0.0, 0.25, 1.0, 1.75, 2.0}) expect_same_geometry(scene, *back, 0, time, 1e-6f);
  ASSERT_EQ(back->lights.size(), 2u);
  EXPECT_EQ(back->lights[1].type, LightType::area_rect);
  EXPECT_EQ(back->lights[1].size_m, glm::vec2(3, 2));
  EXPECT_FALSE(back->materials[1].casts_shadow);
  EXPECT_TRUE(back->materials[0].casts_shadow);
}

TEST(ExportGlb, SharedScenesComeBackWithTheSameTrianglesAtAllTimes) {
  const fs::path folder = fs::path(TENEBRA_SHARED_DIR) / "scenes/extra/gltf";
  // Models of others have licences of their own: they lie beside the checkout, not in it.
  if (!fs::exists(folder)) GTEST_SKIP() << "the folder of extra scenes is not beside the checkout";
  for (const char* name : {"BoxAnimated.glb", "RiggedSimple.glb", "CesiumMan.glb", "AnimatedMorphCube.glb",
                           "Fox.glb", "khronos_blender_io_03_all_animations/03_all_animations.gltf"}) {
    SCOPED_TRACE(name);
    const auto scene = formats::import_gltf(folder / name);
    ASSERT_TRUE(scene.has_value());
    const fs::path path = scratch("shared.glb");
    ASSERT_TRUE(formats::export_glb(*scene, path).has_value());
    const auto back = formats::import_gltf(path);
    fs::remove(path);
    ASSERT_TRUE(back.has_value()) << back.error().message;
    ASSERT_EQ(back->clips.size(), scene->clips.size());
    for (const double time : {0.0, 0.7, 1.3}) expect_same_geometry(*scene, *back, 0, time, 1e-5f);
  }
}

// The tables of the file move when new ones come beside them: references into them must not.
TEST(Export, OfASceneOfSkinsAloneKeepsThem) {
  const fs::path in = scratch("skins.gltf"), out = scratch("skins.glb");
  std::ofstream(in) << R"({"asset":{"version":"2.0"},"nodes":[{}],"skins":[{"joints":[0]}]})";
  const auto unused = formats::import_gltf(in);
  ASSERT_TRUE(unused.has_value()) << unused.error().message;
  ASSERT_TRUE(formats::export_glb(*unused, out).has_value());
  const auto without = formats::import_gltf(out);
  ASSERT_TRUE(without.has_value()) << without.error().message;
  EXPECT_TRUE(without->skins.empty());  // no node uses it

  Scene scene;
  scene.materials.resize(1);
  scene.meshes.resize(1);
  Mesh& mesh = scene.meshes[0];
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  mesh.joints.resize(3, glm::u16vec4(0));
  mesh.weights.resize(3, glm::vec4(1, 0, 0, 0));
  for (int s = 0; s < 5; ++s) {
    Node node;
    node.translation.x = s;
    node.mesh = 0;
    node.skin = s;
    scene.nodes.push_back(node);
    scene.skins.push_back({{s}, {glm::mat4(1)}});
  }
  ASSERT_TRUE(formats::export_glb(scene, out).has_value());
  const auto again = formats::import_gltf(out);
  ASSERT_TRUE(again.has_value()) << again.error().message;
  ASSERT_EQ(again->skins.size(), 5u);
  for (int s = 0; s < 5; ++s) EXPECT_EQ(again->skins[static_cast<std::size_t>(s)].joints, std::vector{s});
  fs::remove(in);
  fs::remove(out);
}

}  // namespace
}  // namespace tenebra
