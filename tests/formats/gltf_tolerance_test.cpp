// glTF files with breaches of the specification that leave their geometry certain: read, with a warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <tenebra/frame_geometry.h>
#include "gltf_builder.h"

namespace tenebra {
namespace {

using testing::GltfBuilder;
using testing::Json;

class GltfTolerance : public ::testing::Test {
protected:
  GltfTolerance() { file_.add_triangle(); }

  Scene read(formats::ImportOptions options = {}) const {
    file_.write(folder_);
    auto scene = formats::import_scene(folder_ / "a.gltf", options);
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  /// What is read of the bytes of a file `name`, with one warning that has `words`.
  void expect_read(const std::string& name, const std::string& bytes, const std::string& words) const {
    testing::write_text(folder_ / name, bytes);
    const auto scene = formats::import_scene(folder_ / name);
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(scene->meshes.at(0).positions[1], glm::vec3(1, 0, 0));
    ASSERT_EQ(scene->warnings.size(), words.empty() ? 0u : 1u);
    EXPECT_TRUE(words.empty() || says(*scene, words)) << scene->warnings[0];
  }
  static bool says(const Scene& scene, const std::string& words) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
  }
  static std::string word(std::size_t number) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFF);
    return bytes;
  }
  /// A GLB of the file with as many blanks behind the JSON and zeros behind the bytes, stated or only there.
  std::string glb(std::size_t stated_blanks, std::size_t padding, std::size_t stated_length = 0) const {
    Json root = file_.root;
    root["buffers"] = {{{"byteLength", file_.bytes.size()}}};
    std::string json = root.dump();
    json.append((4 - json.size() % 4) % 4 + stated_blanks, ' ');
    const std::string body = word(json.size()) + "JSON" + json + std::string(padding, '\0') +
                             word(file_.bytes.size()) + std::string("BIN\0", 4) + file_.bytes;
    return "glTF" + word(2) + word(stated_length != 0 ? stated_length : 12 + body.size()) + body;
  }

  testing::TemporaryFolder folder_;
  GltfBuilder file_;
};

TEST_F(GltfTolerance, ChunksLieWhereTheirLengthsSay) {
  expect_read("a.glb", glb(0, 0), "");
  expect_read("a.glb", glb(2, 0), "expected a multiple of 4");
  expect_read("a.glb", glb(2, 2), "expected a multiple of 4");
  expect_read("a.glb", glb(0, 0, 100'000), "stated length");
  expect_read("a.glb", glb(0, 0) + "??", "behind the end");
}

TEST_F(GltfTolerance, ACutOffFileIsRefusedWithTheNextStep) {
  testing::write_text(folder_ / "a.glb", glb(0, 0).substr(0, glb(0, 0).size() - 4));
  const auto scene = formats::import_scene(folder_ / "a.glb");
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("cut off, copy it again"), std::string::npos) << scene.error().message;
}

TEST_F(GltfTolerance, AByteOrderMarkAndZerosBehindAreNoPartOfTheJson) {
  const Json root = [&] {
    Json with = file_.root;
    with["buffers"] = {{{"uri", "b.bin"}, {"byteLength", file_.bytes.size()}}};
    return with;
  }();
  testing::write_text(folder_ / "b.bin", file_.bytes);
  expect_read("a.gltf", "\xEF\xBB\xBF" + root.dump(), "byte order mark");
  expect_read("a.gltf", root.dump() + std::string(3, '\0'), "zeros");
}

TEST_F(GltfTolerance, BytesAreReadAtAnyPlace) {
  file_.bytes.insert(0, "?");
  file_.root["bufferViews"][0]["byteOffset"] = 1;
  const Scene scene = read();
  EXPECT_EQ(scene.meshes.at(0).positions[1], glm::vec3(1, 0, 0));
  EXPECT_TRUE(says(scene, "accessors[0]: found total offset 1, expected a multiple of 4."));
}

TEST_F(GltfTolerance, ABufferMayLackBytesThatNothingUses) {
  file_.write(folder_);
  file_.root["buffers"] = {{{"uri", "short.bin"}, {"byteLength", file_.bytes.size() + 8}}};
  testing::write_text(folder_ / "short.bin", file_.bytes);
  expect_read("a.gltf", file_.root.dump(), "expected at most the 36 bytes");
  testing::write_text(folder_ / "short.bin", file_.bytes.substr(1));
  const auto scene = formats::import_scene(folder_ / "a.gltf");
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("may be cut off"), std::string::npos) << scene.error().message;
}

TEST_F(GltfTolerance, ASceneThatListsChildrenShowsEachNodeOnceWhereItsTreePutsIt) {
  file_.root["nodes"] = {{{"children", {1}}, {"translation", {5, 0, 0}}, {"mesh", 0}}, {{"mesh", 0}}};
  for (const bool both : {true, false}) {
    file_.root["scenes"][0]["nodes"] = both ? Json{0, 1, 1} : Json{1};
    const Scene scene = read();
    EXPECT_TRUE(says(scene, "found node 1 which is a child"));
    FrameGeometry geometry;
    evaluate_frame(scene, -1, 0, geometry);
    EXPECT_EQ(geometry.triangles.size(), both ? 2u : 1u) << "its parent is there for its place alone";
    EXPECT_EQ(geometry.positions.at(0), glm::vec3(5, 0, 0));
  }
}

TEST_F(GltfTolerance, JointsMayHangFromSeveralRootsOrFromNone) {
  const std::size_t joints =
      file_.accessor<std::uint8_t>({0, 1, 9, 9, 0, 1, 9, 9, 0, 1, 9, 9}, 5121, "VEC4", 4);
  const std::size_t weights = file_.floats({.5, .5, 0, 0, .5, .5, 0, 0, .5, .5, 0, 0}, "VEC4", 4);
  file_.root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints;
  file_.root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
  file_.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "a"}}, {{"translation", {2, 0, 0}}}};
  file_.root["skins"] = {{{"joints", {1, 2}}}};
  for (const Json& listed : {Json{0, 1, 2}, Json{0, 1}}) {
    file_.root["scenes"][0]["nodes"] = listed;
    const Scene scene = read();
    EXPECT_TRUE(says(scene, "under different roots"));
    FrameGeometry geometry;
    evaluate_frame(scene, -1, 0, geometry);
    EXPECT_EQ(geometry.positions.at(0), glm::vec3(1, 0, 0)) << "half of joint 2's way";
  }
}

TEST_F(GltfTolerance, OfTwoChannelsForOnePropertyTheLaterCounts) {
  const std::size_t times = file_.floats({0, 1}, "SCALAR", 1, true);
  const std::size_t first = file_.floats({0, 0, 0, 1, 0, 0}, "VEC3", 3),
                    second = file_.floats({0, 0, 0, 0, 7, 0}, "VEC3", 3);
  const Json target = {{"node", 0}, {"path", "translation"}};
  file_.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", first}}, {{"input", times}, {"output", second}}}},
       {"channels", {{{"sampler", 0}, {"target", target}}, {{"sampler", 1}, {"target", target}}}}}};
  const Scene scene = read();
  EXPECT_TRUE(says(scene, "driven twice"));
  ASSERT_EQ(scene.clips.at(0).channels.size(), 1u);
  FrameGeometry geometry;
  evaluate_frame(scene, 0, 1, geometry);
  EXPECT_EQ(geometry.positions.at(0), glm::vec3(0, 7, 0));
}

TEST_F(GltfTolerance, AMatrixThatNothingMovesStaysAsItIsWritten) {
  // A sun along a wall: the direction has a zero that a quaternion would round away.
  file_.root["nodes"] = {
      {{"matrix", {0.6, 0, -0.8, 0, 0, 1, 0, 0, 0.8, 0, 0.6, 0, 0, 0, 0, 1}}, {"mesh", 0}}};
  const Scene scene = read();
  ASSERT_TRUE(scene.nodes.at(0).matrix.has_value());
  EXPECT_EQ((*scene.nodes[0].matrix)[2], glm::dvec4(0.8, 0, 0.6, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfTolerance, ASunAlongAWallByAMatrixShinesAsIfGivenDirectly) {
  // Along the wall z = 0: what it blocks turns on the sign of N.L, here on a zero.
  const Json turned = {0.6, 0, -0.8, 0, 0, 1, 0, 0, 0.8, 0, 0.6, 0, 0, 0, 0, 1};
  const Json quarter = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};  // -Z becomes +X
  const Json tilted = {1, 0, 0, 0, 0, 0.8, -0.6, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1};
  file_.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
  const Json sun = {{"KHR_lights_punctual", {{"light", 0}}}};
  const auto direction = [&](const Json& outer, const Json& inner) {
    file_.root["nodes"] = {{{"matrix", outer}, {"children", {1}}}, {{"matrix", inner}, {"extensions", sun}}};
    return evaluate_lights(read(), -1, 0).at(0).direction;
  };
  EXPECT_EQ(direction(quarter, tilted), glm::vec3(0.8f, -0.6f, 0));
  EXPECT_EQ(direction(turned, quarter), glm::vec3(0.6f, 0, -0.8f));
  const glm::vec3 down = direction({1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}, tilted);
  EXPECT_EQ(down.x, 0);
  EXPECT_EQ(down, glm::vec3(0, -0.8f, 0.6f));
}

TEST_F(GltfTolerance, AMatrixBesidePartsThatDoNothingIsUsed) {
  Json& node = file_.root["nodes"][0];
  node = {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1}}, {"scale", {1, 1, 1}}};
  EXPECT_EQ((*read().nodes.at(0).matrix)[3].x, 4);
  node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  node["translation"] = {3, 0, 0};
  EXPECT_EQ(read().nodes.at(0).translation.x, 3);
}

TEST_F(GltfTolerance, FaultyCamerasAndLightsAreMadeRight) {
  file_.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 100}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", -1}, {"znear", 0}, {"zfar", -1}}}}};
  file_.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}},
      {{"type", "spot"}, {"intensity", -3}, {"spot", {{"innerConeAngle", 2}, {"outerConeAngle", 3}}}},
      {{"type", "spot"}}};
  const Scene scene = read();
  EXPECT_EQ(scene.cameras.at(0).near_m, 0);
  EXPECT_GT(scene.cameras.at(1).vertical_fov_rad, 0);
  EXPECT_GT(scene.cameras[1].near_m, 0);
  EXPECT_EQ(scene.lights.at(0).inner_cone_rad, scene.lights[0].outer_cone_rad);
  EXPECT_FLOAT_EQ(scene.lights.at(1).outer_cone_rad, static_cast<float>(M_PI / 2));
  EXPECT_EQ(scene.lights[1].intensity, 0);
  EXPECT_FLOAT_EQ(scene.lights.at(2).outer_cone_rad, static_cast<float>(M_PI / 4));
  EXPECT_EQ(scene.warnings.size(), 6u);
  for (const char* const warning :
       {"lights[2].spot: found nothing",
        "cameras[1].perspective.yfov: found -1, expected more than 0; made 0.8.",
        "cameras[1].perspective.znear: found 0, expected more than 0",
        "cameras[1].perspective.zfar: found -1", "lights[1].intensity: found -3, expected 0 or more; made 0.",
        "lights[1].spot: found cone angles 2 and 3, expected 0 <= inner <= outer <= pi/2"})
    EXPECT_TRUE(says(scene, warning)) << warning;
}

TEST_F(GltfTolerance, AttributesThatDoNotFitAreLeftOut) {
  const std::size_t normals = file_.floats({0, 0, 1, 0, 0, 1}, "VEC3", 3);
  file_.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
  const Scene scene = read();
  EXPECT_TRUE(scene.meshes.at(0).normals.empty());
  EXPECT_TRUE(says(scene, "NORMAL: found 2 elements, expected the 3 of POSITION; left out."));
}

TEST_F(GltfTolerance, WhatIsNotNeededMayBeOfAnotherKind) {
  file_.root["asset"] = {{"version", 2.0}};
  file_.root["nodes"][0]["name"] = 5;
  file_.root["accessors"][0]["max"] = "none";
  file_.root["animations"] = {{{"channels", Json::array()}, {"samplers", Json::array()}}};
  EXPECT_EQ(read().meshes.at(0).positions.size(), 3u);
}

TEST_F(GltfTolerance, FilesLieInTheRootThatTheUserNames) {
  std::filesystem::create_directory(folder_ / "models");
  testing::write_text(folder_ / "b.bin", file_.bytes);
  file_.root["buffers"] = {{{"uri", "..\\b.bin"}, {"byteLength", file_.bytes.size()}}};
  const auto path = folder_ / "models/a.gltf";
  testing::write_text(path, file_.root.dump());
  EXPECT_FALSE(formats::import_scene(path).has_value());
  EXPECT_TRUE(formats::import_scene(path, {.root = folder_.path()}).has_value());
  EXPECT_FALSE(formats::import_scene(path, {.root = folder_ / "models"}).has_value());
}

TEST_F(GltfTolerance, ElementsLieAnyStrideApart) {
  file_.root["bufferViews"][0]["byteStride"] = 14;
  file_.bytes.insert(24, "..").insert(12, "..");  // behind the first two positions
  file_.root["bufferViews"][0]["byteLength"] = file_.bytes.size();
  const Scene scene = read();
  EXPECT_EQ(scene.meshes.at(0).positions.at(1), glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes.at(0).positions.at(2), glm::vec3(0, 1, 0));
  EXPECT_TRUE(says(scene, "bufferViews[0].byteStride: found 14"));
}

TEST_F(GltfTolerance, PartsWithoutVerticesOrCornersAreSkipped) {
  Json& accessors = file_.root["accessors"];
  Json& parts = file_.root["meshes"][0]["primitives"];
  accessors.push_back({{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
  accessors.push_back({{"componentType", 5123}, {"count", 0}, {"type", "SCALAR"}});
  parts.push_back({{"attributes", {{"POSITION", accessors.size() - 2}}}});
  parts.push_back(parts[0]);
  parts.back()["indices"] = accessors.size() - 1;
  const Scene scene = read();
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
  EXPECT_TRUE(says(scene, "skipped 2 primitives without vertices"));
}

TEST_F(GltfTolerance, ASceneWithNothingToSeeSaysSoOnce) {
  const auto last = [&] { return read().warnings.back(); };
  file_.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_EQ(last(), "All nodes with triangles are hidden: there is nothing to see.");
  file_.root["nodes"] = {{{"name", "alone"}}};
  EXPECT_EQ(last(), "The scene has no triangles: there is nothing to see.");
  testing::write_text(folder_ / "a.mtl", "newmtl a\nd 0\n");
  testing::write_text(folder_ / "a.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(formats::import_scene(folder_ / "a.obj")->warnings.back(),
            "All materials have alpha 0, or one below their cutoff: there is nothing to see.");
}

TEST_F(GltfTolerance, MaterialsThatCutAllAwaySaySoAndOpaqueOnesDoNot) {
  file_.root["meshes"][0]["primitives"][0]["material"] = 0;
  for (const auto& [mode, alpha, seen] :
       {std::tuple{"MASK", 0.3, false}, {"MASK", 0.5, true}, {"OPAQUE", 0.0, true}}) {
    file_.root["materials"] = {
        {{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}}};
    EXPECT_NE(says(read(), "nothing to see"), seen) << mode << alpha;
  }
}

TEST_F(GltfTolerance, WhatIsNoSceneIsNamedWithTheNextStep) {
  testing::write_text(folder_ / "b.gltf", "{}");
  const std::pair<std::string, std::string> wrong[] = {
      {"PK\x03\x04", "unpack it"},
      {"<!DOCTYPE html>", "download the file itself"},
      {"", "copy it again"},
      {"version https://git-lfs.github.com/spec/v1", "git lfs pull"}};
  for (const auto& [bytes, step] : wrong) {
    testing::write_text(folder_ / "a.glb", bytes);
    EXPECT_NE(formats::import_scene(folder_ / "a.glb").error().message.find(step), std::string::npos) << step;
  }
  testing::write_text(folder_ / "a.xyz", "?");
  EXPECT_NE(formats::import_scene(folder_ / "a.xyz").error().message.find("Export > glTF"),
            std::string::npos);
  std::filesystem::remove(folder_ / "a.glb");
  EXPECT_NE(formats::import_scene(folder_.path()).error().message.find("open b.gltf in it"),
            std::string::npos);
}

}  // namespace
}  // namespace tenebra
