// Compressed geometry: what the libraries' own encoders write comes back; broken data is a sentence.
#include <gtest/gtest.h>

#include <random>

#include <tenebra/frame_geometry.h>
#include "formats/compressed_mesh.h"

namespace tenebra {
namespace {

using testing::contains;
using testing::GltfBuilder;
using testing::Grid;
using testing::joined;
using testing::Json;

std::vector<glm::vec3> corners(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  std::vector<glm::vec3> result;
  for (const glm::uvec3& t : frame.triangles)
    for (int c = 0; c < 3; ++c) result.push_back(frame.positions[t[c]]);
  return result;
}

/// Corners as sorted triples: encoders may reorder triangles and turn their corners.
std::vector<std::array<float, 9>> sorted_triangles(const std::vector<glm::vec3>& corners) {
  std::vector<std::array<float, 9>> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    std::size_t first = i;
    const auto key = [&](std::size_t k) { return std::array{corners[k].x, corners[k].y, corners[k].z}; };
    for (std::size_t k = i; k < i + 3; ++k)
      if (key(k) < key(first)) first = k;
    std::array<float, 9> t{};
    for (std::size_t k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c)
        t[3 * k + static_cast<std::size_t>(c)] = corners[i + (first - i + k) % 3][c];
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void expect_grid(const Scene& scene, const Grid& grid) {
  std::vector<glm::vec3> expected;
  for (const std::uint32_t i : grid.indices) expected.push_back(grid.positions[i]);
  EXPECT_EQ(sorted_triangles(corners(scene)), sorted_triangles(expected));
}

TEST(Meshopt, ReadsAttributesTrianglesAndIndices) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  const Grid grid(30);
  for (const char* mode : {"TRIANGLES", "INDICES"})
    for (const int stride : {2, 4}) {
      SCOPED_TRACE(std::string(mode) + " " + std::to_string(stride));
      const GltfBuilder file = testing::meshopt_file(grid, mode, stride);
      const auto scene = file.import();
      ASSERT_TRUE(scene.has_value()) << scene.error().message;
      EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
      expect_grid(*scene, grid);
    }
}

TEST(Meshopt, IsReadByItsLaterNameToo) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  const Grid grid(8);
  GltfBuilder file = testing::meshopt_file(grid, "TRIANGLES", 4);
  std::string text = file.root.dump();
  for (std::size_t at = 0; (at = text.find("EXT_meshopt")) != std::string::npos;) text.replace(at, 3, "KHR");
  file.root = Json::parse(text);
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
  expect_grid(*scene, grid);
}

TEST(Meshopt, UndoesItsFilters) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  for (const char* filter : {"OCTAHEDRAL", "EXPONENTIAL", "QUATERNION"}) {
    SCOPED_TRACE(filter);
    const testing::Filtered filtered = testing::filtered_file(filter);
    const auto scene = filtered.file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    const auto found = testing::filtered_values(*scene, filter);
    ASSERT_EQ(found.size(), filtered.expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], filtered.expected[i], 2e-3) << i;
  }
}

TEST(Meshopt, RefusesWhatDoesNotFit) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  const GltfBuilder good = testing::meshopt_file(Grid(8), "TRIANGLES", 4);
  const std::pair<const char*, Json> changes[] = {{"byteOffset", 1u << 30},
                                                  {"byteLength", 1u << 30},
                                                  {"byteLength", 3},
                                                  {"byteStride", 3},
                                                  {"byteStride", 0},
                                                  {"count", 0},
                                                  {"count", 1u << 30},
                                                  {"mode", "LINES"},
                                                  {"filter", "BLUR"},
                                                  {"filter", "QUATERNION"},
                                                  {"buffer", 7}};
  for (const char* view : {"0", "1"})
    for (const auto& [name, value] : changes) {
      SCOPED_TRACE(std::string(view) + " " + name + " " + value.dump());
      GltfBuilder file = good;
      file.root[Json::json_pointer(std::string("/bufferViews/") + view +
                                   "/extensions/EXT_meshopt_compression/" + name)] = value;
      const auto scene = file.import();
      ASSERT_FALSE(scene.has_value());
      EXPECT_NE(scene.error().message.find("EXT_meshopt_compression"), std::string::npos)
          << scene.error().message;
    }
}

// A few bytes that claim gigabytes.
TEST(Meshopt, RefusesABomb) {
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  GltfBuilder file = testing::meshopt_file(Grid(8), "TRIANGLES", 4);
  Json& view = file.root["bufferViews"][0];
  view["byteLength"] = 16ull * 200'000'000;
  view["extensions"]["EXT_meshopt_compression"]["count"] = 200'000'000;
  view["extensions"]["EXT_meshopt_compression"]["byteStride"] = 16;
  const auto scene = file.import();
  ASSERT_FALSE(scene.has_value());
}

TEST(Draco, ReadsBothMethods) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_draco()) GTEST_SKIP() << "built without Draco (package libdraco-dev)";
  const Grid grid(30);
  for (const bool edgebreaker : {false, true}) {
    SCOPED_TRACE(edgebreaker);
    const GltfBuilder file = testing::draco_file(grid, edgebreaker);
    const auto scene = file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
    expect_grid(*scene, grid);
  }
}

TEST(Draco, RefusesOtherNumbersThanStated) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_draco()) GTEST_SKIP() << "built without Draco (package libdraco-dev)";
  for (const bool edgebreaker : {false, true})
    for (const int accessor : {0, 1})
      for (const int change : {-3, 3}) {
        SCOPED_TRACE(change);
        GltfBuilder file = testing::draco_file(Grid(8), edgebreaker);
        Json& count = file.root["accessors"][static_cast<std::size_t>(accessor)]["count"];
        count = count.get<int>() + change;
        const auto scene = file.import();
        ASSERT_FALSE(scene.has_value());
        EXPECT_NE(scene.error().message.find("KHR_draco_mesh_compression"), std::string::npos)
            << scene.error().message;
      }
}

// Bytes of the compressed data changed at random: each file loads or fails with a sentence.
void expect_mutants_survive(const GltfBuilder& good, int count) {
  std::mt19937 random(19);
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    GltfBuilder file = good;
    for (std::size_t k = 1 + random() % 4; k > 0; --k)
      file.bytes[random() % file.bytes.size()] = static_cast<char>(random());
    const auto scene = file.import();
    refused += !scene;
    if (!scene) {
      ASSERT_EQ(scene.error().message.find('\n'), std::string::npos) << scene.error().message;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(Meshopt, SurvivesBrokenData) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_meshopt()) GTEST_SKIP() << "built without meshoptimizer (package libmeshoptimizer-dev)";
  expect_mutants_survive(testing::meshopt_file(Grid(12), "TRIANGLES", 4), 500);
  expect_mutants_survive(testing::meshopt_file(Grid(12), "INDICES", 2), 500);
}

TEST(Draco, SurvivesBrokenData) {
  // An optional library; files that need it are refused without it.
  if (!testing::has_draco()) GTEST_SKIP() << "built without Draco (package libdraco-dev)";
  expect_mutants_survive(testing::draco_file(Grid(12), false), 500);
  expect_mutants_survive(testing::draco_file(Grid(12), true), 500);
}

// The garden of the samples once with EXT_meshopt_compression and once without.
TEST(Meshopt, GivesTheFloatsOfTheUncompressedGarden) {
  const auto folder = std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes/extra";
  const auto packed = folder / "malformed/edge/needs_meshopt.glb",
             plain = folder / "gltf/JapaneseBridgeGarden.glb";
  // Models of others have licences of their own: they lie beside the checkout, not in it.
  if (!std::filesystem::exists(packed) || !std::filesystem::exists(plain))
    GTEST_SKIP() << "the folder of extra scenes is not beside the checkout";
  if (!testing::has_meshopt()) {
    const auto scene = formats::import_gltf(packed);
    ASSERT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find("libmeshoptimizer-dev"), std::string::npos) << scene.error().message;
    return;
  }
  const auto a = formats::import_gltf(packed), b = formats::import_gltf(plain);
  ASSERT_TRUE(a.has_value()) << a.error().message;
  ASSERT_TRUE(b.has_value()) << b.error().message;
  EXPECT_EQ(corners(*a), corners(*b));
}

}  // namespace
}  // namespace tenebra
