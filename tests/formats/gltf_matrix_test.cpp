// All pairings of what an accessor may be: component type, normalised, sparse, stride; what extras may hold;
// key times; and scenes of very many nodes and keys.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <functional>
#include <nlohmann/json.hpp>

#include "formats/import_scene.h"
#include "support/child_process.h"
#include "support/peak_memory.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using Json = nlohmann::json;

/// A file with one buffer; views start at multiples of four bytes.
struct File {
  Json root = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"name", "n"}}}}};
  std::string bytes;

  std::size_t view(const std::string& data, int stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
    if (stride > 0) view["byteStride"] = stride;
    root["bufferViews"].push_back(view);
    bytes += data;
    return root["bufferViews"].size() - 1;
  }

  std::size_t accessor(std::size_t view, int component, std::size_t count, const char* type) {
    root["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return root["accessors"].size() - 1;
  }

  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width) {
    std::string data(values.size() * 4, '\0');
    std::memcpy(data.data(), values.data(), data.size());
    return accessor(view(data), 5126, values.size() / width, type);
  }

  void write(const testing::TemporaryFolder& folder) const {
    Json whole = root;
    if (!bytes.empty()) whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "b.bin"}}};
    testing::write_text(folder / "b.bin", bytes);
    testing::write_text(folder / "a.gltf", whole.dump());
  }

  Expected<Scene> import() const {
    const testing::TemporaryFolder folder;
    write(folder);
    return formats::import_gltf(folder / "a.gltf");
  }
};

struct Component {
  int type;
  int bytes;
  double largest;  ///< what 1 is as a normalised integer; 0: floats
  bool has_sign;
};

const Component components[] = {{5120, 1, 127, true},
                                {5121, 1, 255, false},
                                {5122, 2, 32767, true},
                                {5123, 2, 65535, false},
                                {5126, 4, 0, true}};

std::string store(double value, const Component& component) {
  std::string data(static_cast<std::size_t>(component.bytes), '\0');
  if (component.type == 5126) {
    const auto number = static_cast<float>(value);
    std::memcpy(data.data(), &number, 4);
  } else {
    const auto number = static_cast<std::int32_t>(value);
    std::memcpy(data.data(), &number, data.size());  // little endian
  }
  return data;
}

/// Three corners with stored coordinates of both signs; sparse ones replace corner 1 by (4, 5, 6).
struct Corners {
  Component component;
  bool normalized, sparse, base;
  int padding, sparse_index_bytes;

  double stored(int corner, int axis) const {
    if (sparse && corner == 1) return 4 + axis;
    if (!base) return 0;
    const double value = 3 * corner + axis + 1;
    return component.has_sign && axis == 1 ? -value : value;
  }

  double expected(int corner, int axis) const {
    const double value = stored(corner, axis);
    return normalized && component.largest > 0 ? value / component.largest : value;
  }

  int stride() const { return (3 * component.bytes + 3) / 4 * 4 + padding; }

  File file() const {
    File file;
    std::string data, replaced;
    for (int corner = 0; corner < 3; ++corner) {
      std::string element;
      for (int axis = 0; axis < 3; ++axis)
        element += store(corner == 1 && sparse ? 99 : stored(corner, axis), component);
      element.resize(static_cast<std::size_t>(stride()), '\x7f');
      data += element;
    }
    Json accessor = {{"componentType", component.type}, {"count", 3}, {"type", "VEC3"}};
    if (base) accessor["bufferView"] = file.view(data, stride());
    if (normalized) accessor["normalized"] = true;
    if (sparse) {
      for (int axis = 0; axis < 3; ++axis) replaced += store(4 + axis, component);
      const std::string index("\1\0\0\0", static_cast<std::size_t>(sparse_index_bytes));
      const int index_type = sparse_index_bytes == 1 ? 5121 : sparse_index_bytes == 2 ? 5123 : 5125;
      accessor["sparse"] = {{"count", 1},
                            {"indices", {{"bufferView", file.view(index)}, {"componentType", index_type}}},
                            {"values", {{"bufferView", file.view(replaced)}}}};
    }
    file.root["accessors"].push_back(accessor);
    file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
    file.root["nodes"][0]["mesh"] = 0;
    return file;
  }
};

TEST(GltfMatrix, EveryComponentTypeNormalisedSparseAndStride) {
  int files = 0;
  for (const Component& component : components)
    for (const bool normalized : {false, true})
      for (const bool sparse : {false, true})
        for (const bool base : {true, false})
          for (const int padding : {0, 4, 232})
            for (const int index_bytes : {1, 2, 4}) {
              if ((!sparse && (index_bytes > 1 || !base)) || (normalized && component.largest == 0)) continue;
              if (!base && padding > 0) continue;
              const Corners corners{component, normalized, sparse, base, padding, index_bytes};
              SCOPED_TRACE(fmt::format("type {} normalised {} sparse {} base {} stride {} index {}",
                                       component.type, normalized, sparse, base, corners.stride(),
                                       index_bytes));
              const auto scene = corners.file().import();
              ASSERT_TRUE(scene.has_value()) << scene.error().message;
              ASSERT_EQ(scene->meshes[0].positions.size(), 3u);
              for (int corner = 0; corner < 3; ++corner)
                for (int axis = 0; axis < 3; ++axis)
                  EXPECT_EQ(scene->meshes[0].positions[static_cast<std::size_t>(corner)][axis],
                            static_cast<float>(corners.expected(corner, axis)));
              ++files;
            }
  EXPECT_EQ(files, 9 * (3 + 9 + 3));
}

TEST(GltfMatrix, TheLeastNormalisedIntegerIsMinusOne) {
  for (const Component& component : components) {
    if (!component.has_sign || component.largest == 0) continue;
    File file;
    std::string data;
    for (int i = 0; i < 3; ++i) {
      std::string corner = store(-component.largest - 1, component) + store(-component.largest, component) +
                           store(component.largest, component);
      corner.resize((corner.size() + 3) / 4 * 4, '\0');
      data += corner;
    }
    file.accessor(file.view(data, component.bytes == 1 ? 4 : 8), component.type, 3, "VEC3");
    file.root["accessors"][0]["normalized"] = true;
    file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
    file.root["nodes"][0]["mesh"] = 0;
    const auto scene = file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(scene->meshes[0].positions[0], glm::vec3(-1, -1, 1));
  }
}

TEST(GltfExtras, OfTheSceneAreReadAndIgnoredWhenMalformed) {
  File file;
  file.root["scenes"][0]["extras"] = {{"ambient_light", {1, 2, 3}}, {"background", {0.25, 0.5, 1}}};
  auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_EQ(scene->ambient_light, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene->background, glm::vec3(0.25f, 0.5f, 1));
  const Json odd[] = {nullptr, true,         1,           "white",    Json::array(),
                      {1, 2},  {1, 2, 3, 4}, {1, 2, "3"}, {{1}, 2, 3}};
  for (const Json& value : odd) {
    SCOPED_TRACE(value.dump());
    file.root["scenes"][0]["extras"] = {
        {"ambient_light", value}, {"background", value}, {"casts_shadow", value}};
    scene = file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_EQ(scene->ambient_light, glm::vec3(0.1f));
    EXPECT_EQ(scene->background, glm::vec3(0));
    file.root["scenes"][0]["extras"] = value;
    EXPECT_TRUE(file.import().has_value());
  }
}

TEST(GltfExtras, OfMaterialsAndLightsAreIgnoredWhenMalformed) {
  const Json odd[] = {nullptr, true, 1, "linear", Json::array(), {1, 2}, {1, 2, "3"}, {{"a", 1}}};
  for (const Json& value : odd) {
    SCOPED_TRACE(value.dump());
    File file;
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["materials"] = {{{"extras", {{"ambient", value}, {"base_color", value}}}}};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 7}, {"extras", {{"falloff", value}, {"intensity", value}}}}};
    const auto scene = file.import();
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    EXPECT_LT(scene->materials[0].ambient.x, 0);
    EXPECT_EQ(scene->materials[0].base_color, glm::vec3(1));
    EXPECT_EQ(scene->lights[0].falloff, Falloff::inverse_square);
    EXPECT_EQ(scene->lights[0].intensity, 7);
  }
}

File animated(const std::vector<float>& times) {
  File file;
  const auto input = file.floats(times, "SCALAR", 1);
  file.root["accessors"][input]["min"] = {*std::min_element(times.begin(), times.end())};
  file.root["accessors"][input]["max"] = {*std::max_element(times.begin(), times.end())};
  const auto output = file.floats(std::vector<float>(3 * times.size(), 1.0f), "VEC3", 3);
  file.root["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  return file;
}

TEST(GltfKeys, MustRiseFromZero) {
  EXPECT_TRUE(animated({0}).import().has_value());
  EXPECT_TRUE(animated({0, 1e-30f, 5}).import().has_value());
  for (const auto& times :
       std::vector<std::vector<float>>{{0, 1, 1}, {0, 2, 1}, {-1, 0}, {1, 1}, {3, 2, 1}, {INFINITY}}) {
    File file = animated(times);
    for (const char* bound : {"min", "max"})
      if (!std::isfinite(times[0])) file.root["accessors"][0].erase(bound);
    const auto scene = file.import();
    ASSERT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find("animations[0].samplers[0].input: found key time"),
              std::string::npos)
        << scene.error().message;
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Imports in a child: 2 s of processor time, and the memory that import_scene.h promises. `good` judges the
/// scene.
void expect_quick_import(const File& file, const std::function<bool(const Scene&)>& good) {
  const testing::TemporaryFolder folder;
  file.write(folder);
  const std::uint64_t size = file.bytes.size() + std::filesystem::file_size(folder / "a.gltf");
  const std::uint64_t before = testing::peak_bytes();
  const int code = testing::run_in_child([&] {
    const auto scene = formats::import_gltf(folder / "a.gltf");
    if (static_cast<double>(std::clock()) / CLOCKS_PER_SEC > 2) return 1;
    if (testing::peak_bytes() > before + (std::uint64_t{256} << 20) + 20 * size) return 2;
    return scene.has_value() && good(*scene) ? 0 : 3;
  });
  EXPECT_EQ(code, 0) << "1: time, 2: memory, 3: scene";
}

TEST(GltfExtremes, AHundredThousandNodesTakeLessThanTwoSeconds) {
  File flat, chain;
  flat.root["nodes"] = chain.root["nodes"] = Json::array();
  flat.root["scenes"][0]["nodes"] = Json::array();
  for (int i = 0; i < 100'000; ++i) {
    flat.root["nodes"].push_back({{"name", fmt::format("node {}", i)}, {"translation", {i, 0, 0}}});
    flat.root["scenes"][0]["nodes"].push_back(i);
    chain.root["nodes"].push_back(i + 1 < 100'000 ? Json{{"children", {i + 1}}} : Json{{"name", "leaf"}});
  }
  for (const File& file : {flat, chain}) {
    expect_quick_import(file, [](const Scene& scene) { return scene.nodes.size() == 100'000; });
  }
}

TEST(GltfExtremes, ListedNodesBelowALongChainTakeLessThanTwoSeconds) {
  File file;
  constexpr int half = 50'000;
  file.root["nodes"] = Json::array();
  for (int i = 0; i < half; ++i) file.root["nodes"].push_back({{"children", {i + 1}}});
  Json& last = file.root["nodes"].back()["children"];
  last.clear();
  for (int i = half; i < 2 * half; ++i) {
    file.root["nodes"].push_back({{"name", "leaf"}});
    last.push_back(i);
    file.root["scenes"][0]["nodes"].push_back(i);
  }
  expect_quick_import(
      file, [](const Scene& scene) { return scene.nodes.size() == 2 * half && scene.warnings.size() == 1; });
}

/// `count` instances of one triangle, each with a place of its own.
File instanced(std::size_t count) {
  File file;
  const auto corners = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  file.root["accessors"][corners]["min"] = {0, 0, 0};
  file.root["accessors"][corners]["max"] = {1, 1, 0};
  const auto places = file.floats(std::vector<float>(3 * count, 2.0f), "VEC3", 3);
  file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", corners}}}}}}}};
  file.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  file.root["nodes"][0] = {
      {"mesh", 0},
      {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}};
  return file;
}

TEST(GltfExtremes, AMillionInstancesTakeLessThanTwoSeconds) {
  expect_quick_import(instanced(1'000'000),
                      [](const Scene& scene) { return scene.nodes.size() == 1'000'001; });
}

TEST(GltfExtremes, MoreInstancesThanFitAreRefusedWithTheirNumber) {
  File file = instanced(1);
  file.root["accessors"][1].erase("bufferView");  // as many zeros as it says
  file.root["accessors"][1]["count"] = 700'000;
  const auto scene = file.import();
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("found 700000 instances in all, expected at most 5"),
            std::string::npos)
      << scene.error().message;
}

TEST(GltfExtremes, AMillionKeysTakeLessThanTwoSeconds) {
  std::vector<float> times;
  for (int i = 0; i < 1'000'000; ++i) times.push_back(static_cast<float>(i) / 1024);
  expect_quick_import(animated(times), [](const Scene& scene) {
    return scene.clips[0].tracks[0].times_s.size() == 1'000'000;
  });
}
#endif

}  // namespace
}  // namespace tenebra
