// Rules of the glTF importer one by one, on files made here; then thousands of mutants of them.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "formats/import_scene.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Folder {
  fs::path path = fs::temp_directory_path() / fmt::format("tenebra_gltf_{}", getpid());
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

/// Four corners of a unit square, `stride` bytes apart, then indices 0 1 2 3 of `width` bytes.
struct Square {
  int stride = 12, width = 2, mode = 5;
  bool indexed = true;

  std::string bytes() const {
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    std::string out;
    for (const auto& corner : corners) {
      std::string element(static_cast<std::size_t>(stride), '\x7f');
      std::memcpy(element.data(), corner, 12);
      out += element;
    }
    for (std::uint32_t i = 0; i < 4; ++i)
      out.append(reinterpret_cast<const char*>(&i), static_cast<std::size_t>(width));
    return out;
  }

  Json json() const {
    Json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    if (indexed) primitive["indices"] = 1;
    const int component = width == 1 ? 5121 : width == 2 ? 5123 : 5125;
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {primitive}}}}},
            {"buffers", {{{"uri", "square.bin"}, {"byteLength", 4 * stride + 4 * width}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteLength", 4 * stride}, {"byteStride", stride}},
              {{"buffer", 0}, {"byteOffset", 4 * stride}, {"byteLength", 4 * width}}}},
            {"accessors",
             {{{"bufferView", 0},
               {"componentType", 5126},
               {"count", 4},
               {"type", "VEC3"},
               {"min", {0, 0, 0}},
               {"max", {1, 1, 0}}},
              {{"bufferView", 1}, {"componentType", component}, {"count", 4}, {"type", "SCALAR"}}}}};
  }
};

TEST(GltfImport, ReadsEveryStrideIndexWidthAndMode) {
  const Folder folder;
  for (const int stride : {12, 16, 252})
    for (const int width : {1, 2, 4})
      for (const int mode : {0, 1, 4, 5, 6})
        for (const bool indexed : {true, false}) {
          SCOPED_TRACE(fmt::format("stride {} width {} mode {} indexed {}", stride, width, mode, indexed));
          const Square square{stride, width, mode, indexed};
          folder.write("square.bin", square.bytes());
          const auto scene = formats::import_gltf(folder.write("square.gltf", square.json().dump()));
          ASSERT_TRUE(scene.has_value()) << scene.error().message;
          const Mesh& mesh = scene->meshes[0];
          const std::vector<glm::uvec3> strip = {{0, 1, 2}, {1, 3, 2}}, fan = {{1, 2, 0}, {2, 3, 0}},
                                        list = {{0, 1, 2}};
          EXPECT_EQ(mesh.triangles, mode < 4    ? std::vector<glm::uvec3>{}
                                    : mode == 4 ? list
                                    : mode == 5 ? strip
                                                : fan);
          EXPECT_EQ(scene->warnings.empty(), mode > 4);
          if (mode >= 4) {
            EXPECT_EQ(mesh.positions[3], glm::vec3(1, 1, 0));
          }
        }
}

struct Refusal {
  const char* pointer;
  Json value;
  const char* place;  ///< what the sentence must name
};

TEST(GltfImport, RefusesWithThePlace) {
  const Folder folder;
  const Square square;
  folder.write("square.bin", square.bytes());
  const Refusal refusals[] = {
      {"/accessors/0/bufferView", 9, "accessors[0].bufferView"},
      {"/accessors/0/count", 5, "accessors[0]"},
      {"/accessors/0/count", 9007199254740991, "accessors[0].count"},
      {"/accessors/0/byteOffset", 9007199254740988, "accessors[0]"},
      {"/accessors/1/count", -1, "accessors[1].count"},
      {"/bufferViews/0/byteStride", 8, "accessors[0]"},
      {"/bufferViews/1/byteLength", 1e300, "bufferViews[1].byteLength"},
      {"/nodes/0/matrix", {1, 2, 3}, "nodes[0].matrix"},
      {"/nodes/0/children", {0}, "nodes"},
      {"/nodes/0/skin", 0, "nodes[0].skin"},
      {"/buffers/0/uri", "../square.bin", "buffers[0].uri"},
      {"/buffers/0/uri", "%2e%2e/square.bin", "buffers[0].uri"},
      {"/buffers/0/uri", "/etc/passwd", "buffers[0].uri"},
      {"/buffers/0/uri", "file:square.bin", "buffers[0].uri"},
      {"/buffers/0/uri", "http://localhost/a.bin", "buffers[0].uri"},
      {"/buffers/0/uri", "link.bin", "buffers[0].uri"},
      {"/extensionsRequired", {"KHR_unknown_geometry"}, "KHR_unknown_geometry"},
  };
  fs::create_symlink("/etc/hostname", folder.path / "link.bin");
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(fmt::format("{} = {}", refusal.pointer, refusal.value.dump()));
    Json json = square.json();
    json[Json::json_pointer(refusal.pointer)] = refusal.value;
    const auto scene = formats::import_gltf(folder.write("square.gltf", json.dump()));
    ASSERT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find(refusal.place), std::string::npos) << scene.error().message;
  }
}

TEST(GltfImport, FollowsAChainOfTenThousandNodes) {
  const Folder folder;
  Json json = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {9999}}}}}};
  for (int i = 0; i < 10000; ++i)
    json["nodes"].push_back(i == 0 ? Json{{"name", "leaf"}} : Json{{"children", {i - 1}}});
  const auto scene = formats::import_gltf(folder.write("chain.gltf", json.dump()));
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  ASSERT_EQ(scene->nodes.size(), 10000u);
  for (int i = 0; i < 10000; ++i) EXPECT_EQ(scene->nodes[static_cast<std::size_t>(i)].parent, i - 1);
}

// 5000 accessors over the same bytes: each small, together hours of work.
TEST(GltfImport, RefusesAccessorsThatReadTheSameBytesOverAndOver) {
  const Folder folder;
  Json json = {{"asset", {{"version", "2.0"}}},
               {"buffers", {{{"byteLength", 1200000}, {"uri", "zeros.bin"}}}},
               {"bufferViews", {{{"buffer", 0}, {"byteLength", 1200000}}}}};
  for (int i = 0; i < 5000; ++i)
    json["accessors"].push_back(
        {{"bufferView", 0}, {"componentType", 5121}, {"count", 1200000}, {"type", "SCALAR"}});
  folder.write("zeros.bin", std::string(1200000, '\0'));
  const auto scene = formats::import_gltf(folder.write("over.gltf", json.dump()));
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("accessors["), std::string::npos) << scene.error().message;
}

TEST(GltfImport, RefusesDeepJson) {
  const Folder folder;
  const std::string deep = "{\"asset\":" + std::string(100000, '[') + std::string(100000, ']') + "}";
  const auto scene = formats::import_gltf(folder.write("deep.gltf", deep));
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().message.find("nesting"), std::string::npos) << scene.error().message;
}

TEST(ObjImport, CutsAConcavePolygonWithoutLeavingIt) {
  const Folder folder;
  const auto scene =
      formats::import_obj(folder.write("arrow.obj", "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf -4 -3 -2 -1\n"));
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  float area = 0;
  for (const auto& t : scene->meshes[0].triangles) {
    const auto& p = scene->meshes[0].positions;
    const float z = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z;
    EXPECT_GT(z, 0);
    area += z / 2;
  }
  EXPECT_FLOAT_EQ(area, 4);  // twice the triangle (0,0) (4,0) (1,1)
}

TEST(ObjImport, WarnsOfMaterialsOutsideTheFolder) {
  const Folder folder;
  const auto scene =
      formats::import_obj(folder.write("a.obj", "mtllib ../a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  ASSERT_TRUE(scene.has_value());
  ASSERT_FALSE(scene->warnings.empty());
  EXPECT_NE(scene->warnings[0].find("../a.mtl"), std::string::npos);
}

std::string mutate(std::string text, std::mt19937& random) {
  static const std::string pieces[] = {"-1", "0",  "99999999999", "1e300",      "null", "[",
                                       "]",  "{}", "\"",          "4294967295", ","};
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t k = 1 + below(3); k > 0; --k) {
    const std::size_t at = below(text.size()), length = std::min<std::size_t>(below(8), text.size() - at);
    switch (below(4)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, pieces[below(std::size(pieces))]);
        break;
      default:
        text.insert(at, text.substr(below(text.size()), 8));
        break;
    }
  }
  return text;
}

void expect_survives(const Folder& folder, const std::string& name, const std::string& seed_text, int count) {
  std::mt19937 random(2011);
  for (int i = 0; i < count; ++i) {
    const fs::path path = folder.write(name, mutate(seed_text, random));
    const auto scene = path.extension() == ".obj" ? formats::import_obj(path) : formats::import_gltf(path);
    if (scene) continue;
    ASSERT_NE(scene.error().message.find(name), std::string::npos) << "mutant " << i;
    ASSERT_EQ(scene.error().message.find('\n'), std::string::npos)
        << "mutant " << i << ": " << scene.error().message;
  }
}

TEST(Mutants, OfGltfGlbAndObjLoadOrFailWithASentence) {
  const Folder folder;
  const Square square;
  folder.write("square.bin", square.bytes());
  const fs::path good = folder.write("square.gltf", square.json().dump());
  const auto scene = formats::import_gltf(good);
  ASSERT_TRUE(scene.has_value());
  ASSERT_TRUE(formats::export_glb(*scene, folder.path / "square.glb").has_value());
  std::ifstream stream(folder.path / "square.glb", std::ios::binary);
  const std::string glb((std::istreambuf_iterator<char>(stream)), {});
  expect_survives(folder, "mutant.gltf", square.json().dump(), 4000);
  expect_survives(folder, "mutant.glb", glb, 3000);
  expect_survives(folder, "mutant.obj",
                  "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1\n",
                  3000);
}

}  // namespace
}  // namespace tenebra
