// The corpus of broken and odd files: each loads or fails with one sentence, in bounded time and memory.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/import_scene.h"
#include "support/peak_memory.h"

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
  return path.extension() == ".obj" ? formats::import_obj(path) : formats::import_gltf(path);
}

/// Codes of the errors in the validator's report and where they stand; nothing without a report.
using Errors = std::vector<std::pair<std::string, std::string>>;
std::optional<Errors> reported_errors(const fs::path& path) {
  std::ifstream stream(path.string() + ".report.json");
  if (!stream) return std::nullopt;
  const auto report = nlohmann::json::parse(stream);
  Errors errors;
  for (const auto& message : report["issues"]["messages"])
    if (message["severity"] == 0) errors.emplace_back(message["code"], message.value("pointer", ""));
  return errors;
}

/// What our sentence on an error must say.
const std::multimap<std::string, std::string> words_of = {
    {"ACCESSOR_ANIMATION_INPUT_NEGATIVE", "found key time -1"},
    {"ACCESSOR_ANIMATION_INPUT_NON_INCREASING", "expected rising times"},
    {"ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "outside its min and max"},
    {"ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "outside its min and max"},
    {"ACCESSOR_INDEX_PRIMITIVE_RESTART", "found index 255"},
    {"ACCESSOR_INVALID_FLOAT", "not finite"},
    {"ACCESSOR_INVALID_SIGN", "normals not of unit length"},  // tangents are not read
    {"ACCESSOR_MAX_MISMATCH", "outside its min and max"},
    {"ACCESSOR_MIN_MISMATCH", "outside its min and max"},
    {"ACCESSOR_NON_CLAMPED", "outside 0 to 1"},
    {"ACCESSOR_OFFSET_ALIGNMENT", "expected a multiple of 4"},
    {"ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "sparse.count: found 2"},
    {"ACCESSOR_TOO_LONG", "expected them within"},
    {"ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "expected a multiple of 4"},
    {"ACCESSOR_VECTOR3_NON_UNIT", "normals not of unit length"},
    {"ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "without morph targets"},
    {"ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS", "found 1 key"},
    {"ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", "found no min and max"},
    {"BUFFER_VIEW_INVALID_BYTE_STRIDE", "byteStride"},
    {"BUFFER_VIEW_TOO_LONG", "expected them within the 4 bytes"},
    {"CAMERA_XMAG_YMAG_ZERO", "expected both not zero"},
    {"CAMERA_ZFAR_LEQUAL_ZNEAR", "expected more than znear"},
    {"EMPTY_ENTITY", "found an empty"},
    {"GLB_CHUNK_LENGTH_UNALIGNED", "expected a multiple of 4"},
    {"GLB_CHUNK_TOO_BIG", "bytes of header"},
    {"GLB_CHUNK_TOO_BIG", "stated length"},
    {"GLB_DUPLICATE_CHUNK", "found no bytes"},
    {"GLB_EMPTY_CHUNK", "found no bytes"},
    {"GLB_INVALID_MAGIC", "found magic"},
    {"GLB_LENGTH_MISMATCH", "stated length"},
    {"GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "bytes of header"},
    {"GLB_UNEXPECTED_FIRST_CHUNK", "expected JSON"},
    {"IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "byteStride"},
    {"IMAGE_MIME_TYPE_INVALID", "mimeType: found"},
    {"INVALID_JSON", "JSON"},
    {"INVALID_URI", ".uri: found"},
    {"IO_ERROR", "found no such file"},
    {"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "of another type, expected VEC3"},
    {"MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", "byteStride"},
    {"MESH_PRIMITIVE_INVALID_ATTRIBUTE", "found unknown"},
    {"MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", "elements, expected the 3 of POSITION"},
    {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "found no min and max"},
    {"MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "elements, expected the 3 of POSITION"},
    {"NODE_LOOP", "a loop of children"},
    {"NODE_MATRIX_NON_TRS", "expected an affine matrix"},
    {"NODE_SKIN_WITH_NON_SKINNED_MESH", "without JOINTS_0"},
    {"SCENE_NON_ROOT_NODE", "is a child"},
    {"SKIN_NO_COMMON_ROOT", "under different roots"},
    {"TYPE_MISMATCH", "expected an object"},
    {"UNDEFINED_PROPERTY", "found nothing, expected this property"},
    {"UNKNOWN_ASSET_MAJOR_VERSION", "expected 2.x"},
    {"UNRESOLVED_REFERENCE", "found reference"},
    {"UNSATISFIED_DEPENDENCY", "expected one"},
    {"VALUE_NOT_IN_RANGE", "found 0, expected 1 or more"},
};

/// The first name and number of a JSON pointer in our spelling: /nodes/0/skin gives nodes[0].
std::string place_of(const std::string& pointer) {
  const std::size_t name = pointer.find('/', 1);
  if (pointer.empty() || name == std::string::npos) return pointer.substr(pointer.empty() ? 0 : 1);
  const std::string number = pointer.substr(name + 1, pointer.find('/', name + 1) - name - 1);
  const bool is_number =
      std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  return pointer.substr(1, name - 1) + (is_number ? "[" + number + "]" : "." + number);
}

/// Whether one of `sentences` says the words of `code`, and where it stands.
bool is_said(const std::vector<std::string>& sentences, const std::string& code, const std::string& pointer) {
  const auto [first, last] = words_of.equal_range(code);
  for (auto words = first; words != last; ++words)
    for (const std::string& sentence : sentences) {
      const bool placed = code == "BUFFER_VIEW_INVALID_BYTE_STRIDE" ||
                          code == "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE" ||
                          code.starts_with("GLB_") || sentence.find(place_of(pointer)) != std::string::npos;
      if (placed && sentence.find(words->second) != std::string::npos) return true;
    }
  return false;
}

TEST(Malformed, EveryFileLoadsOrFailsWithASentenceThatNamesIt) {
  const auto files = models();
  // Files from other projects' tests have licences of their own: they lie beside the checkout, not in it.
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

TEST(Malformed, WhatTheValidatorCallsAnErrorIsRefusedOrWarnedOfForThatReason) {
  const auto files = models();
  // Files from other projects' tests have licences of their own: they lie beside the checkout, not in it.
  if (files.empty()) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  int with_errors = 0, without = 0;
  for (const fs::path& file : files) {
    const auto errors = reported_errors(file);
    if (!errors) continue;
    SCOPED_TRACE(file.string());
    const auto scene = import_any(file);
    (errors->empty() ? without : with_errors)++;
    if (errors->empty()) {
      EXPECT_TRUE(scene.has_value()) << scene.error().message;
      continue;
    }
    const auto sentences = scene ? scene->warnings : std::vector{scene.error().message};
    int said = 0;
    for (const auto& [code, pointer] : *errors) {
      EXPECT_TRUE(words_of.contains(code)) << code;
      const bool found = is_said(sentences, code, pointer);
      said += found;
      if (scene) {
        EXPECT_TRUE(found) << code << " at " << pointer << ": "
                           << fmt::format("{}", fmt::join(sentences, " "));
      }
    }
    EXPECT_GT(said, 0) << fmt::format("{}",
                                      fmt::join(sentences, " "));  // a refusal names the first fault alone
  }
  EXPECT_GE(with_errors, 60);
  EXPECT_GE(without, 20);
}

TEST(Malformed, EveryFileTakesLittleTimeAndMemory) {
  // The memory that is compared would be the sanitizer's.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need memory of their own";
#endif
  const auto files = models();
  // Files from other projects' tests have licences of their own: they lie beside the checkout, not in it.
  if (files.empty()) GTEST_SKIP() << "the folder of malformed files is not beside the checkout";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      alarm(10);
      { const auto scene = import_any(file); }
      _exit(testing::peak_bytes() <= (std::uint64_t{256} << 20) + 20 * fs::file_size(file) ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  }
}

struct Good {
  const char* file;
  std::size_t triangles;
  double end_s;  ///< longest clip
};
void PrintTo(const Good& good, std::ostream* out) {  // CTest's name of the test
  *out << good.file;
}

class SharedScenes : public ::testing::TestWithParam<Good> {};

TEST_P(SharedScenes, HaveTheTrianglesAndTheLengthsOfTheirReadme) {
  const fs::path path = fs::path(TENEBRA_SHARED_DIR) / "scenes/extra" / GetParam().file;
  // Models of others have licences of their own: they lie beside the checkout, not in it.
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
    ::testing::Values(
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
