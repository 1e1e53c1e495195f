// The corpus of broken and odd files: each loads or fails with one sentence, in bounded time and memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "import/import_scene.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;

fs::path corpus() {
  return fs::path(TENEBRA_SHARED_DIR) / "scenes/extra/malformed";
}

std::vector<fs::path> models() {
  std::vector<fs::path> found;
  if (!fs::exists(corpus())) return found;
  for (const auto& entry : fs::recursive_directory_iterator(corpus())) {
    const fs::path extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb" || extension == ".obj") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

Expected<Scene> import_any(const fs::path& path) {
  return path.extension() == ".obj" ? import_obj(path) : import_gltf(path);
}

/// Errors that the validator's report counts; -1 without a report.
int reported_errors(const fs::path& path) {
  std::ifstream stream(path.string() + ".report.json");
  if (!stream) return -1;
  return nlohmann::json::parse(stream)["issues"]["numErrors"];
}

std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

TEST(Malformed, EveryFileLoadsOrFailsWithASentenceThatNamesIt) {
  const auto files = models();
  if (files.empty()) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  EXPECT_GE(files.size(), 108u);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    const auto scene = import_any(file);
    if (scene) continue;
    const std::string& message = scene.error().message;
    EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.back(), '.') << message;
  }
}

TEST(Malformed, WhatTheValidatorCallsAnErrorIsRefusedOrWarnedOf) {
  const auto files = models();
  if (files.empty()) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  int with_errors = 0, without = 0;
  for (const fs::path& file : files) {
    const int errors = reported_errors(file);
    if (errors < 0) continue;
    SCOPED_TRACE(file.string());
    const auto scene = import_any(file);
    (errors > 0 ? with_errors : without)++;
    if (errors > 0)
      EXPECT_TRUE(!scene || !scene->warnings.empty());
    else
      EXPECT_TRUE(scene.has_value()) << scene.error().message;
  }
  EXPECT_GE(with_errors, 60);
  EXPECT_GE(without, 20);
}

TEST(Malformed, EveryFileTakesLittleTimeAndMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need memory of their own";
#endif
  const auto files = models();
  if (files.empty()) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      alarm(10);
      { const auto scene = import_any(file); }
      _exit(peak_bytes() <= (std::uint64_t{256} << 20) + 20 * fs::file_size(file) ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  }
}

TEST(Malformed, RequiredExtensionsAreRefusedByName) {
  const fs::path file = corpus() / "edge/needs_meshopt.glb";
  if (!fs::exists(file)) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  const auto scene = import_gltf(file);
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("EXT_meshopt_compression"), std::string::npos)
      << scene.error().message;
}

struct Good {
  const char* file;
  std::size_t triangles;
  double end_s;  ///< longest clip
};

class SharedScenes : public testing::TestWithParam<Good> {};

TEST_P(SharedScenes, HaveTheTrianglesAndTheLengthsOfTheirReadme) {
  const fs::path path = fs::path(TENEBRA_SHARED_DIR) / "scenes/extra" / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << "the folder of extra scenes is not beside the checkout";
  const auto scene = import_any(path);
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  std::size_t triangles = 0;
  for (const Node& node : scene->nodes)
    if (node.mesh >= 0) triangles += scene->meshes[static_cast<std::size_t>(node.mesh)].triangles.size();
  EXPECT_EQ(triangles, GetParam().triangles);
  double end_s = 0;
  for (const Clip& clip : scene->clips) end_s = std::max(end_s, clip.end_s);
  EXPECT_NEAR(end_s, GetParam().end_s, 0.006);
  for (std::size_t i = 0; i < scene->nodes.size(); ++i)
    EXPECT_LT(scene->nodes[i].parent, static_cast<int>(i));
}

INSTANTIATE_TEST_SUITE_P(
    Extra, SharedScenes,
    testing::Values(
        Good{"gltf/BoxAnimated.glb", 254, 3.71}, Good{"gltf/BoxInterleaved.glb", 12, 0},
        Good{"gltf/RiggedSimple.glb", 188, 2.08}, Good{"gltf/CesiumMan.glb", 4672, 2},
        Good{"gltf/AnimatedMorphCube.glb", 12, 4.2}, Good{"gltf/Fox.glb", 576, 3.42},
        Good{"gltf/SimpleMorph/SimpleMorph.gltf", 1, 4}, Good{"gltf/SimpleMeshes/SimpleMeshes.gltf", 2, 0},
        Good{"gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 0},
        Good{"gltf/TriangleWithoutIndices/TriangleWithoutIndices.gltf", 1, 0},
        Good{"gltf/Cameras/Cameras.gltf", 2, 0}, Good{"gltf/SimpleSkin/SimpleSkin.gltf", 8, 5.5},
        Good{"gltf/Lantern/Lantern.gltf", 5394, 0}, Good{"gltf/FlightHelmet/FlightHelmet.gltf", 94722, 0},
        Good{"gltf/ManyCubes/many-cubes.gltf", 6012, 0},
        Good{"gltf/khronos_blender_io_01_cs_rotate/01_cs_rotate.gltf", 12, 2},
        Good{"gltf/khronos_blender_io_01_cs_translate/01_cs_translate.gltf", 12, 2},
        Good{"gltf/khronos_blender_io_01_cs_scale/01_cs_scale.gltf", 12, 2},
        Good{"gltf/khronos_blender_io_01_cs_morph/01_cs_morph.gltf", 12, 2},
        Good{"gltf/khronos_blender_io_02_node_hierarchy/02_node_hierarchy.gltf", 60, 0},
        Good{"gltf/khronos_blender_io_03_all_animations/03_all_animations.gltf", 976, 2},
        Good{"gltf/khronos_blender_io_24_animation_pointer/24_animation_pointer.gltf", 14436, 10.02},
        Good{"gltf/JapaneseBridgeGarden.glb", 21883, 0}, Good{"gltf/HotelRoom.glb", 99029, 0},
        Good{"obj/spot.obj", 23062, 0}, Good{"obj/spot_low_resolution.obj", 1654, 0},
        Good{"obj/bunny.obj", 6598, 0}, Good{"obj/boat.obj", 32416, 0}, Good{"obj/cornell_box.obj", 34, 0}));

}  // namespace
}  // namespace tenebra
