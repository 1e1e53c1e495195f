// tenebra info and tenebra convert: what a scene holds, before and after conversion.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using nlohmann::json;

json info_of(const std::string& scene) {
  const auto result = tenebra({"info", scene, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return json::parse(result.output);
}

void expect_moving_scene(const json& info) {
  EXPECT_EQ(info["counts"]["triangles"], moving_scene_triangles);
  EXPECT_EQ(info["counts"]["casting_triangles"], moving_scene_triangles);
  EXPECT_EQ(info["bounds_m"]["low"], json({-4.0, 0.0, -4.0}));
  EXPECT_EQ(info["bounds_m"]["high"], json({4.0, 1.0, 4.0}));
  ASSERT_EQ(info["lights"].size(), 2u);
  EXPECT_EQ(info["lights"][1]["type"], "point");
  EXPECT_EQ(info["lights"][1]["position_m"], json({1.0, 3.0, 0.0}));
  EXPECT_EQ(info["lights"][1]["intensity"], 10.0);
  ASSERT_EQ(info["cameras"].size(), 1u);
  EXPECT_EQ(info["cameras"][0]["name"], "eye");
  EXPECT_NEAR(info["cameras"][0]["vertical_fov_deg"], 45.8366, 1e-3);
  ASSERT_EQ(info["clips"].size(), 1u);
  EXPECT_EQ(info["clips"][0]["name"], "slide");
  EXPECT_EQ(info["clips"][0]["end_s"], 10.0);
  EXPECT_EQ(info["clips"][0]["frames"], moving_scene_frames);
}

TEST(InfoCommand, TellsWhatTheSceneHolds) {
  const TemporaryFolder folder;
  expect_moving_scene(info_of(write_moving_scene(folder, 2)));
}

TEST(InfoCommand, ListsTheFormatsAndTheirReaders) {
  const auto text = tenebra({"info", "--formats"});
  EXPECT_EQ(text.exit_code, 0) << text.errors;
  EXPECT_NE(text.output.find(".gltf .glb"), std::string::npos) << text.output;
  const auto listed = tenebra({"info", "--formats", "--json"});
  std::map<std::string, std::string> reader;
  for (const json& format : json::parse(listed.output)) reader[format["extensions"]] = format["reader"];
  EXPECT_EQ(reader[".ply"], "own");
  EXPECT_EQ(reader[".fbx"], "Assimp");
}

TEST(InfoCommand, TellsTheSameAsText) {
  const TemporaryFolder folder;
  const auto result = tenebra({"info", write_moving_scene(folder)});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  for (const char* line : {"triangles: 3\n", "lights: 1\n", "cameras: 1\n", "name slide", "warnings: 0\n"}) {
    EXPECT_NE(result.output.find(line), std::string::npos) << line << "\n" << result.output;
  }
}

TEST(InfoCommand, ListsTheMachinesOpenGl) {
  const auto result = tenebra({"info", "--gl", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json all = json::parse(result.output);
  ASSERT_FALSE(all["offers"].empty());
  int taken = 0;
  bool software = true;
  for (const json& offer : all["offers"]) {
    EXPECT_NE(offer.contains("lacks"), offer.contains("renderer")) << offer;
    if (!offer["taken_by_auto"].get<bool>()) continue;
    ++taken;
    software = offer["software"].get<bool>();
  }
  EXPECT_EQ(taken, 1) << all;
  EXPECT_EQ(all["raster_auto"], software ? "cpu" : "gl");
  const auto text = tenebra({"info", "--gl"});
  EXPECT_NE(text.output.find("auto takes this one"), std::string::npos) << text.output;
}

TEST(InfoCommand, NeedsASceneOrGl) {
  const auto result = tenebra({"info"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("SCENE is required"), std::string::npos) << result.errors;
}

TEST(InfoCommand, RoundsNumbersForPeopleAndNotInJson) {
  const TemporaryFolder folder;
  write_text(folder / "a.obj", "v -12.2 0.1 -0\nv 2 0.1 0\nv 0 3 0\nf 1 2 3\n");
  const auto text = tenebra({"info", folder / "a.obj"});
  EXPECT_NE(text.output.find("bounds_m: low (-12.2, 0.1, 0), high (2, 3, 0)\n"), std::string::npos)
      << text.output;
  EXPECT_EQ(info_of(folder / "a.obj")["bounds_m"]["low"][0], static_cast<double>(-12.2f));
}

TEST(InfoCommand, TellsTheSizeOfAreaLightsAndTheConesOfSpots) {
  const TemporaryFolder folder;
  write_text(folder / "a.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"extensionsUsed":["KHR_lights_punctual","EXT_lights_area"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","range":7,
"spot":{"innerConeAngle":0.5,"outerConeAngle":0.75}}]},
"EXT_lights_area":{"lights":[{"type":"rect","intensity":5,"size":0.5,"rect":{"aspect":3}}]}},
"nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}},
{"scale":[2,2,2],"extensions":{"EXT_lights_area":{"light":0}}}]})");
  const json info = info_of(folder / "a.gltf");
  ASSERT_EQ(info["lights"].size(), 2u);
  EXPECT_NEAR(info["lights"][0]["half_angles_deg"][0], 28.6479, 1e-3);
  EXPECT_NEAR(info["lights"][0]["half_angles_deg"][1], 42.9718, 1e-3);
  EXPECT_EQ(info["lights"][0]["range_m"], 7.0);
  EXPECT_FALSE(info["lights"][0].contains("size_m"));
  EXPECT_EQ(info["lights"][1]["size_m"], json({3.0, 1.0}));
}

TEST(InfoCommand, ReadsAnObjWithoutLightsOrCameras) {
  const TemporaryFolder folder;
  write_text(folder / "a.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\n");
  const json info = info_of(folder / "a.obj");
  EXPECT_EQ(info["counts"]["triangles"], 1);
  EXPECT_EQ(info["bounds_m"]["high"], json({2.0, 3.0, 0.0}));
  EXPECT_TRUE(info["lights"].empty());
  EXPECT_TRUE(info["cameras"].empty());
}

TEST(InfoCommand, CountsSurfacesAndNamesPictures) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pictures");
  write_text(folder / "pictures/t.ppm", std::string("P6 2 1 255\n") + "abcdef");
  const std::string triangle = " 0 0 0 0 0  1 0 0 1 0  0 1 0 0 1\n";
  write_text(folder / "a.aff", "fm 0 0 0 1 1 1 .5 .5 .5 20 0 1\ntt t.ppm" + triangle + "tt t.ppm" + triangle +
                                   "fm 0 0 0 1 1 1 0 0 0 20 .5 1\np 3 0 0 0 1 0 0 0 1 0\n");
  const auto result = tenebra({"info", folder / "a.aff", "--json", "--texture-path", folder / "pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json info = json::parse(result.output);
  EXPECT_EQ(info["triangles_with"]["textured"], 2);
  EXPECT_EQ(info["triangles_with"]["specular"], 2);
  EXPECT_EQ(info["triangles_with"]["transmission"], 1);
  EXPECT_EQ(info["triangles_with"]["alpha_mask"], 0);
  EXPECT_EQ(info["colors"], "display values");
  EXPECT_EQ(info["images"], json::array({{{"name", "t.ppm"}, {"size_px", {2, 1}}}}));
  EXPECT_TRUE(info["warnings"].empty());
  const auto without = tenebra({"info", folder / "a.aff"});
  EXPECT_NE(without.output.find("triangles_with: textured 0, normal_mapped 0, specular 2"), std::string::npos)
      << without.output;
  EXPECT_NE(without.output.find("texture 't.ppm'"), std::string::npos) << without.output;
}

TEST(InfoCommand, NamesExtensionsAndWhatIsNotUsed) {
  const TemporaryFolder folder;
  write_text(folder / "a.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_sheen"],
"materials":[{"extensions":{"KHR_materials_sheen":{}}},{"extensions":{"KHR_materials_sheen":{}}}]})");
  const json info = info_of(folder / "a.gltf");
  EXPECT_EQ(info["extensions"], json::array({"KHR_materials_sheen"}));
  EXPECT_EQ(info["unused"], json::array({{{"name", "KHR_materials_sheen"}, {"count", 2}}}));
  EXPECT_EQ(info["warnings"], json::array({"The scene has no triangles: there is nothing to see."}));
  const auto result = tenebra({"info", folder / "a.gltf"});
  EXPECT_NE(result.output.find("\nunused: KHR_materials_sheen (2)\n"), std::string::npos) << result.output;
}

TEST(ConvertCommand, KeepsTheSceneAndItsAnimation) {
  const TemporaryFolder folder;
  const auto result = tenebra({"convert", write_moving_scene(folder, 2), folder / "moved.glb"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(read_text(folder / "moved.glb").starts_with("glTF"));
  expect_moving_scene(info_of(folder / "moved.glb"));
}

TEST(ConvertCommand, ReportsWhatItCannotWrite) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  for (const std::string& path : {(folder / "no/a.glb").string(), std::string(300, 'n') + ".glb"}) {
    const auto result = tenebra({"convert", scene, path});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(path), std::string::npos) << result.errors;
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"moving.bin", "moving.gltf"}));
}

}  // namespace
}  // namespace tenebra::testing
