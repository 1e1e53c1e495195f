// Parts of files that exporters write: scenes to choose from, instances, extensions by policy, a GLB's end.
#include <gtest/gtest.h>

#include <tenebra/frame_geometry.h>
#include "formats/gltf_builder.h"

namespace tenebra {
namespace {

using testing::contains;
using testing::GltfBuilder;
using testing::joined;
using testing::Json;

GltfBuilder two_scenes() {
  GltfBuilder file;
  file.add_triangle();
  file.root["nodes"].push_back({{"name", "other"}, {"mesh", 0}, {"translation", {5, 0, 0}}});
  file.root["scenes"] = {{{"name", "first"}, {"nodes", {0}}}, {{"name", "1st"}, {"nodes", {0, 1}}}};
  return file;
}

TEST(GltfScenes, AreChosenByNameOrNumber) {
  const GltfBuilder file = two_scenes();
  for (const auto& [wanted, nodes] : {std::pair{"", 1u}, {"0", 1u}, {"first", 1u}, {"1", 2u}, {"1st", 2u}}) {
    SCOPED_TRACE(wanted);
    const auto scene = file.import({.scene = wanted});
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(scene->nodes.size(), nodes);
    EXPECT_EQ(contains(scene->warnings, "--scene"), std::string(wanted).empty());
  }
  const auto none = file.import({.scene = "2"});
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().message.find("'2', expected one of 0 'first', 1 '1st'"), std::string::npos)
      << none.error().message;
}

TEST(GltfScenes, AreNotAskedOfOtherFormats) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(formats::import_scene(folder / "a.obj").has_value());
  EXPECT_FALSE(formats::import_scene(folder / "a.obj", {.scene = "0"}).has_value());
}

struct Instanced : GltfBuilder {
  Instanced() {
    add_triangle();
    root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    Json& attributes = root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["TRANSLATION"] = floats({0, 0, 0, 10, 0, 0, 20, 0, 0}, "VEC3", 3);
    const float r = std::sqrt(0.5f);
    attributes["ROTATION"] = floats({0, 0, 0, 1, 0, 0, r, r, 0, 0, 0, 1}, "VEC4", 4);
    attributes["SCALE"] = floats({1, 1, 1, 1, 1, 1, 2, 2, 2}, "VEC3", 3);
    root["nodes"][0]["translation"] = {0, 100, 0};
  }
};

void expect_instances(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  ASSERT_EQ(frame.triangles.size(), 3u);
  const glm::vec3 expected[9] = {{0, 100, 0}, {1, 100, 0},  {0, 101, 0},  {10, 100, 0}, {10, 101, 0},
                                 {9, 100, 0}, {20, 100, 0}, {22, 100, 0}, {20, 102, 0}};
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_LT(glm::distance(frame.positions[frame.triangles[i / 3][static_cast<int>(i % 3)]], expected[i]),
              1e-5f)
        << i;
}

TEST(GltfInstances, StandWhereTheirAttributesSay) {
  const auto scene = Instanced().import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
  expect_instances(*scene);
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(formats::export_glb(*scene, folder / "out.glb").has_value());
  const auto again = formats::import_gltf(folder / "out.glb");
  ASSERT_TRUE(again.has_value()) << again.error().message;
  expect_instances(*again);
}

TEST(GltfInstances, OfMorphingMeshesFollowTheWeightsOfTheirNode) {
  Instanced file;
  const auto target = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3, true);
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
  const auto times = file.floats({0, 1}, "SCALAR", 1, true), weights = file.floats({0, 1}, "SCALAR", 1);
  file.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", weights}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  FrameGeometry frame;
  evaluate_frame(*scene, 0, 0.5, frame);
  ASSERT_EQ(frame.positions.size(), 9u);
  EXPECT_FLOAT_EQ(frame.positions[0].z, 0.5f);
  EXPECT_FLOAT_EQ(frame.positions[3].z, 0.5f);
  EXPECT_FLOAT_EQ(frame.positions[6].z, 1);
}

TEST(GltfInstances, OfHugeNumbersAreRefused) {
  Instanced file;
  for (std::size_t i : {1u, 2u, 3u}) {
    file.root["accessors"][i].erase("bufferView");
    file.root["accessors"][i]["count"] = 3'000'000'000u;
  }
  const auto scene = file.import();
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("found 3000000000 instances in all"), std::string::npos)
      << scene.error().message;
  Instanced unequal;
  unequal.root["accessors"][2]["count"] = 2;
  EXPECT_FALSE(unequal.import().has_value());
}

TEST(GltfExtensions, ThatTouchLooksAloneAreAWarningWhereRequired) {
  for (const char* name : {"EXT_texture_astc", "EXT_texture_avif", "KHR_materials_diffuse_transmission",
                           "MSFT_texture_dds", "KHR_xmp_json_ld"}) {
    GltfBuilder file;
    file.add_triangle();
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = {name};
    const auto scene = file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_TRUE(contains(scene->warnings, name)) << joined(scene->warnings);
  }
  for (const char* name : {"EXT_unknown_subdivision", "KHR_unknown", "VENDOR_mesh_texture_trees"}) {
    GltfBuilder file;
    file.add_triangle();
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = {name};
    const auto scene = file.import();
    ASSERT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find(name), std::string::npos) << scene.error().message;
  }
  GltfBuilder file;
  file.add_triangle();
  file.root["extensionsUsed"] = {"EXT_unknown_subdivision"};
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(contains(scene->warnings, "EXT_unknown_subdivision")) << joined(scene->warnings);
}

TEST(GltfContainer, BytesBehindTheEndOfAGlbAreAWarning) {
  GltfBuilder file;
  file.add_triangle();
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value());
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(formats::export_glb(*scene, folder / "a.glb").has_value());
  std::string bytes = testing::read_text(folder / "a.glb");
  testing::write_text(folder / "long.glb", bytes + "xyz");
  const auto longer = formats::import_gltf(folder / "long.glb");
  ASSERT_TRUE(longer.has_value()) << longer.error().message;
  EXPECT_TRUE(contains(longer->warnings, "found 3 bytes behind the end"));
  testing::write_text(folder / "short.glb", bytes.substr(0, bytes.size() - 4));
  EXPECT_FALSE(formats::import_gltf(folder / "short.glb").has_value());
}

// Accessors without a bufferView are zeros wherever they stand.
TEST(GltfAccessors, WithoutAViewAreZeros) {
  GltfBuilder file;
  file.add_triangle();
  for (const char* type : {"VEC3", "VEC4", "SCALAR"})
    file.root["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", type}});
  file.root["accessors"].push_back({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
  Json& primitive = file.root["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = 1;
  primitive["indices"] = 4;
  primitive["targets"] = {{{"POSITION", 1}}};
  const auto times = file.floats({0, 1, 2}, "SCALAR", 1, true);
  file.root["animations"] = {{{"samplers",
                               {{{"input", times}, {"output", 1}},
                                {{"input", times}, {"output", 2}},
                                {{"input", 3}, {"output", 1}}}},
                              {"channels",
                               {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                                {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                {{"sampler", 2}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  FrameGeometry frame;
  evaluate_frame(*scene, 0, 1, frame);
  EXPECT_EQ(frame.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene->meshes[0].triangles[0], glm::uvec3(0));
}

}  // namespace
}  // namespace tenebra
