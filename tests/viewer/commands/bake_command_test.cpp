// tenebra bake: its files read back, are the same for any number of threads, and its failures are sentences.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "formats/import_scene.h"
#include "io/exr/exr_file.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

/// The moving scene's floor and blocker with a second set of texture coordinates, each all of 0 to 1.
std::string write_mapped_scene(const TemporaryFolder& folder) {
  Scene scene = formats::import_scene(write_moving_scene(folder)).value();
  for (Mesh& mesh : scene.meshes)
    for (const glm::vec3& p : mesh.positions) {
      const float reach = mesh.positions.size() > 3 ? 4.0f : 1.0f;
      mesh.texture_coordinates[1].push_back(0.5f + 0.5f * glm::vec2(p.x, p.z) / reach);
    }
  const std::string file = folder / "mapped.glb";
  EXPECT_TRUE(formats::export_glb(scene, file).has_value());
  return file;
}

/// The moving scene without its light.
std::string write_dark_scene(const TemporaryFolder& folder) {
  Scene scene = formats::import_scene(write_moving_scene(folder)).value();
  scene.lights.clear();
  for (Node& node : scene.nodes) node.light = -1;
  const std::string file = folder / "dark.glb";
  EXPECT_TRUE(formats::export_glb(scene, file).has_value());
  return file;
}

TEST(BakeCommand, ColoursVerticesOfWhatLightReaches) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result = tenebra({"bake", scene, "-o", folder / "lit.glb", "--what", "light"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.output.starts_with("9 vertices, 1 lights,")) << result.output;
  const auto lit = formats::import_scene(folder / "lit.glb");
  ASSERT_TRUE(lit.has_value()) << lit.error().message;
  EXPECT_TRUE(lit->warnings.empty());
  ASSERT_EQ(lit->meshes.size(), 2u);
  for (const Mesh& mesh : lit->meshes) ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
  EXPECT_GT(lit->meshes[0].colors[0].r, 0.01f);
  EXPECT_EQ(lit->materials[0].model, SurfaceModel::unlit);
}

TEST(BakeCommand, MapsAreTheSameForAnyThreads) {
  const TemporaryFolder folder;
  const std::string scene = write_mapped_scene(folder);
  std::vector<std::string> maps, scenes;
  for (const char* threads : {"1", "2"}) {
    const std::string out = folder / (std::string("lit") + threads + ".glb");
    const auto result = tenebra({"bake", scene, "--to", "lightmap", "--size", "64", "--threads", threads,
                                 "--ambient", "0.1,0.1,0.1", "-o", out});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.errors.find("each got a square of the map"), std::string::npos) << result.errors;
    maps.push_back(read_text(folder / (std::string("lit") + threads + ".exr")));
    scenes.push_back(read_text(out));
  }
  EXPECT_EQ(maps[0], maps[1]);
  EXPECT_EQ(scenes[0], scenes[1]);
  const auto map = io::exr::read(folder / "lit1.exr");
  ASSERT_TRUE(map.has_value()) << map.error().message;
  EXPECT_EQ(map->width, 64);
  EXPECT_GT(*std::max_element(map->pixels.begin(), map->pixels.end()), 0.2f);
  const auto lit = formats::import_scene(folder / "lit1.glb");
  ASSERT_TRUE(lit.has_value()) << lit.error().message;
  for (const Mesh& mesh : lit->meshes)
    for (const glm::vec2& uv : mesh.texture_coordinates[1])
      EXPECT_TRUE(uv.x > 0 && uv.x < 1 && uv.y > 0 && uv.y < 1);
}

TEST(BakeCommand, FailsInOneSentence) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder), out = folder / "out.glb";
  const auto sentence = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "bake");
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(out));
    return result.errors;
  };
  const auto says = [&](const std::vector<std::string>& arguments, const char* words) {
    const std::string text = sentence(arguments);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  says({scene, "-o", folder / "out.gltf"}, "expected a name that ends in .glb");
  says({scene, "-o", out, "--to", "lightmap"}, "TEXCOORD_1");
  says({scene, "-o", out, "--size", "64"}, "--size is for --to lightmap");
  says({scene, "-o", out, "--to", "lightmap", "--map", folder / "a.jpg"}, ".exr or .png");
  says({scene, "-o", out, "--to", "lightmap", "--size", "9"}, "16 to 8192");
  says({scene, "-o", out, "--to", "lightmap", "--size", "8192", "--samples", "8"}, "at most 32768");
  says({scene, "-o", out, "--frame", "301"}, "frames 0 to 300");
  says({scene, "-o", out, "--light", "4"}, "the scene has 1 lights");
  says({scene, "-o", out, "--ambient", "-1,0,0"}, "0 or more");
  says({TENEBRA_SCENES_DIR "/court.glb", "-o", out, "--what", "light", "--shadows", "soft", "--light-size",
        "1", "--memory", "soft:1"},
       "not enough memory for soft shadows");
  says({write_dark_scene(folder), "-o", out, "--sky", "none"}, "found no light");
  const std::string mapped = write_mapped_scene(folder);
  says({mapped, "-o", mapped}, "mapped.glb");
}

TEST(BakeCommand, BakesTheLightThatPicturesOfADarkFileHave) {
  const TemporaryFolder folder;
  const std::string out = folder / "lit.glb";
  const auto result = tenebra({"bake", write_dark_scene(folder), "-o", out, "--what", "light"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("The scene has no light; a sun"), std::string::npos) << result.errors;
  const Scene baked = formats::import_scene(out).value();
  EXPECT_TRUE(baked.lights.empty()) << "the sun is in the colours";
  EXPECT_EQ(baked.cameras.size(), 1u) << "the file's";
  float brightest = 0;
  for (const Mesh& mesh : baked.meshes)
    for (const glm::vec4& color : mesh.colors) brightest = std::max(brightest, color.x);
  EXPECT_NEAR(brightest, 0.75 * std::sin(glm::radians(50.0)), 0.01) << "the sun on the floor";
}

TEST(BakeCommand, StopsInTime) {
  const TemporaryFolder folder;
  const auto result = tenebra({"bake", TENEBRA_SCENES_DIR "/court.glb", "-o", folder / "out.glb",
                               "--ao-error", "0.1", "--timeout", "0.4"});
  EXPECT_EQ(result.exit_code, 124) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
}

}  // namespace
}  // namespace tenebra::testing
