// The specification's rules, one breach at a time: each is refused or warned of in the words of the table,
// and the file without the breach loads without a word; so does one whose breach changes nothing here.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "formats/gltf_builder.h"

namespace tenebra {
namespace {

using testing::contains;
using testing::GltfBuilder;
using testing::joined;
using testing::Json;

/// A file that has everything the table breaks, and breaks nothing itself.
GltfBuilder faultless() {
  GltfBuilder file;
  Json& root = file.root;
  // Accessors 0 to 10.
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3, true);                           // positions
  file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);                                 // normals
  file.accessor<std::uint16_t>({0, 1, 2}, 5123, "SCALAR", 1);                          // indices
  file.accessor<std::uint8_t>({0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4);  // joints
  file.floats({0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);                  // weights
  file.floats({0, 1}, "SCALAR", 1, true);                                              // times
  file.floats({0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", 4);                                    // rotations
  file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3, true);                           // displacements
  file.floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
      "MAT4", 16);                                                // inverse binds
  file.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4", 4);  // tangents
  file.floats({0, 1}, "SCALAR", 1);                               // morph weights
  root["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"JOINTS_0", 3}, {"WEIGHTS_0", 4}, {"TANGENT", 9}}},
          {"indices", 2},
          {"material", 0},
          {"targets", {{{"POSITION", 7}}}}}}}}};
  root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
  root["nodes"] = {{{"mesh", 0}, {"skin", 0}},   {{"children", {2, 3}}}, {{"rotation", {0, 0, 0, 1}}},
                   {{"translation", {0, 0, 1}}}, {{"camera", 0}},        {{"name", "alone"}}};
  root["scenes"] = {{{"nodes", {0, 1, 4}}}};
  root["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", 8}, {"skeleton", 1}}};
  root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  root["animations"] = {{{"samplers", {{{"input", 5}, {"output", 6}}, {{"input", 5}, {"output", 10}}}},
                         {"channels",
                          {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}},
                           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  root["extensionsUsed"] = {"KHR_lights_punctual"};
  root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"color", {1, 1, 1}}}};
  root["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", "b.bin"}}};
  return file;
}

TEST(GltfValidity, TheFaultlessFileHasNoFault) {
  const auto scene = faultless().import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
}

struct Breach {
  const char* pointer;  ///< where to put `value`; "" merges nothing
  Json value;           ///< null: the property is taken away
  const char* words;    ///< in the sentence; null: it changes nothing, and nothing is said
};

std::vector<Breach> breaches() {
  return {
      // JSON and the asset
      {"/asset/version", nullptr, "asset.version: found nothing"},
      {"/asset/version", "2", "asset.version"},
      {"/asset/version", "3.0", "expected 2.x"},
      {"/asset/minVersion", "2.1", "asset: found version 2.0"},
      {"/asset/generator", 5, nullptr},
      {"/extensionsRequired", {"KHR_texture_transform"}, nullptr},
      {"/extensionsUsed", {"KHR_lights_punctual", "KHR_lights_punctual"}, nullptr},
      {"/extensionsUsed", {"KHR_lights_punctual", "KHR_mesh_quantization"}, nullptr},
      {"/nodes/0/extensions", {{"EXT_foo", Json::object()}}, nullptr},
      {"/nodes", Json::array(), "found"},
      {"/meshes/0/name", 7, "meshes[0].name"},
      {"/bufferViews/0/name", 7, nullptr},
      // buffers and views
      {"/buffers/0/byteLength", 0, "buffers[0].byteLength"},
      {"/buffers/0/byteLength", 1u << 20, "buffers[0].byteLength"},
      {"/buffers/0/uri", "data:text/plain;base64,AAAA", "buffers[0].byteLength"},
      {"/buffers/0/uri", "nowhere.bin", "buffers[0].uri"},
      {"/bufferViews/0/byteLength", 0, "bufferViews[0].byteLength"},
      {"/bufferViews/0/byteOffset", 1u << 20, "bufferViews[0]"},
      {"/bufferViews/0/buffer", 1, "bufferViews[0].buffer"},
      {"/bufferViews/0/byteStride", 2, "stride of 2"},
      {"/bufferViews/0/byteStride", 14, "byteStride"},
      {"/bufferViews/0/byteStride", 252, "accessors[0]: found 3 elements"},
      {"/bufferViews/-", {{"buffer", 0}, {"byteLength", 8}, {"byteStride", 16}}, nullptr},
      {"/bufferViews/0/target", 34963, nullptr},
      {"/bufferViews/2/target", 34962, nullptr},
      {"/bufferViews/8/target", 34962, nullptr},
      {"/bufferViews/2/byteStride", 4, "byteStride"},
      {"/bufferViews/5/byteStride", 4, nullptr},
      {"/bufferViews/8/byteStride", 64, nullptr},
      // accessors
      {"/accessors/0/bufferView", 99, "accessors[0].bufferView"},
      {"/accessors/0/count", 0, "primitives without vertices"},
      {"/accessors/0/count", 4, "accessors[0]"},
      {"/accessors/0/byteOffset", 2, "accessors[0]"},
      {"/accessors/0/normalized", true, nullptr},
      {"/accessors/0/min", {0, 0}, nullptr},
      {"/accessors/0/min", {-1, 0, 0}, "accessors[0]: found a min or max that is not that of its values"},
      {"/accessors/0/max", {0.5, 1, 0}, "accessors[0]: found 1 values outside its min and max"},
      {"/accessors/0/min", nullptr, nullptr},
      {"/accessors/2/max", {1.5}, "accessors[2]: found 1 values outside its min and max"},
      {"/accessors/2/min", {-1}, nullptr},
      {"/accessors/5/min", nullptr, "found no min and max"},
      {"/accessors/0/type", "VEC5", "found accessors[0] of another type"},
      {"/accessors/0/componentType", 5124, "found accessors[0] of another type"},
      {"/accessors/8/byteOffset", 2, "accessors[8]"},
      {"/accessors/0/sparse",
       {{"count", 9},
        {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
        {"values", {{"bufferView", 0}}}},
       "accessors[0].sparse"},
      {"/accessors/0/sparse",
       {{"count", 3},
        {"indices", {{"bufferView", 2}, {"componentType", 5122}}},
        {"values", {{"bufferView", 0}}}},
       nullptr},
      // meshes
      {"/meshes/0/primitives", Json::array(), "meshes[0].primitives"},
      {"/meshes/0/primitives/0/attributes", Json::object(), "skipped 1 primitives without vertices"},
      {"/meshes/0/primitives/0/mode", 7, "primitives[0].mode"},
      {"/meshes/0/primitives/0/indices", 0, "indices"},
      {"/meshes/0/primitives/0/indices", 5, "indices"},
      {"/meshes/0/primitives/0/material", 1, "material"},
      {"/meshes/0/primitives/0/targets/0/COLOR_0", 7, nullptr},
      {"/meshes/0/primitives/0/targets/0/TEXCOORD_0", 7, nullptr},
      {"/meshes/0/primitives/0/targets/0/WEIGHTS_0", 4, nullptr},
      {"/meshes/0/primitives/0/targets/0/NORMAL", 4, "expected VEC3"},
      {"/meshes/0/weights", {0, 1}, "meshes[0].weights"},
      {"/meshes/0/primitives/0/attributes/POSITION", 4, "POSITION"},
      {"/meshes/0/primitives/0/attributes/NORMAL", 4, "NORMAL"},
      {"/meshes/0/primitives/0/attributes/TANGENT", 0, nullptr},
      {"/meshes/0/primitives/0/attributes/TANGENT", 4, nullptr},  // no normal map reads them
      {"/meshes/0/primitives/0/attributes/TEXCOORD_1", 0, "TEXCOORD_1: found accessors[0] of another type"},
      {"/meshes/0/primitives/0/attributes/COLOR_0", 3, nullptr},
      {"/meshes/0/primitives/0/attributes/BOGUS", 0, "found unknown 'BOGUS'"},
      {"/meshes/0/primitives/0/attributes/_MINE", 2, nullptr},
      {"/meshes/0/primitives/0/attributes/JOINTS_0", 4, "JOINTS_0"},
      {"/meshes/0/primitives/0/attributes/WEIGHTS_0", nullptr, "JOINTS_0 or WEIGHTS_0 alone"},
      {"/meshes/0/primitives/0/attributes/WEIGHTS_0", 9, "skin weights do not sum to 1"},
      // materials, textures, images
      {"/materials/0/pbrMetallicRoughness/baseColorFactor",
       {1, 2, 1, 1},
       "baseColorFactor: found 2, expected 0 to 1"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", -1, "metallicFactor: found -1, expected 0 to 1"},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", 2, "roughnessFactor: found 2, expected 0 to 1"},
      {"/materials/0/emissiveFactor", {0, 0, 2}, nullptr},
      {"/materials/0/alphaCutoff", -1, nullptr},
      {"/materials/0/doubleSided", "yes", "doubleSided"},
      {"/materials/0/alphaMode", 5, "alphaMode"},
      {"/materials/0/normalTexture", {{"index", 0}}, "normalTexture"},
      {"/images", Json::array({Json::object()}), nullptr},
      {"/images", {{{"bufferView", 0}}}, nullptr},
      // nodes and scenes
      {"/scene", 1, "scene"},
      {"/scenes/0/nodes", {2}, "which is a child"},
      {"/scenes/0/nodes", {0, 0}, "twice"},
      {"/nodes/1/children", {2, 3, 1}, "nodes["},
      {"/nodes/4/children", {2}, "expected one parent"},
      {"/nodes/4/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "expected an affine matrix"},
      {"/nodes/4/matrix", {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "found no product"},
      {"/nodes/3/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, nullptr},
      {"/nodes/2/rotation", {0, 0, 0, 2}, "nodes[2].rotation"},
      {"/nodes/2/rotation", {0, 0, 0, 0}, "nodes[2].rotation"},
      {"/nodes/2/scale", {1, 1}, "nodes[2].scale"},
      {"/nodes/4/weights", {1}, "weights"},
      {"/nodes/4/skin", 0, "nodes[4].skin"},
      {"/nodes/4/camera", 1, "nodes[4].camera"},
      // skins
      {"/skins/0/joints", Json::array(), "skins[0].joints"},
      {"/skins/0/joints", {2, 4}, "under different roots"},
      {"/skins/0/skeleton", 2, nullptr},
      {"/skins/0/inverseBindMatrices", 0, "inverseBindMatrices"},
      {"/accessors/8/count", 1, "inverseBindMatrices"},
      {"/scenes/1", {{"nodes", {0}}}, "number 0 is shown"},
      // cameras and lights
      {"/cameras/0/perspective/yfov", 0, "yfov"},
      {"/cameras/0/perspective/znear", 0, "znear"},
      {"/cameras/0/perspective/zfar", 0.05, "zfar"},
      {"/cameras/0/perspective/zfar", 0, nullptr},
      {"/cameras/0/perspective/aspectRatio", 0, nullptr},
      {"/cameras/0/orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}, nullptr},
      {"/cameras/0/type", "fisheye", "cameras[0].type"},
      {"/extensions/KHR_lights_punctual/lights/0/color", {1, 2, 1}, nullptr},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", -1, "intensity"},
      {"/extensions/KHR_lights_punctual/lights/0/range", 0, nullptr},
      {"/extensions/KHR_lights_punctual/lights/0/type", "spot", "lights[0].spot: found nothing"},
      {"/extensions/KHR_lights_punctual/lights/0/type", "laser", "lights[0].type"},
      {"/nodes/4/extensions", {{"KHR_lights_punctual", {{"light", 1}}}}, "light"},
      // animations
      {"/animations/0/channels", Json::array(), "animations[0].channels"},
      {"/animations/0/samplers", Json::array(), "animations[0].samplers"},
      {"/animations/0/channels/0/sampler", 2, "animations[0].channels[0].sampler"},
      {"/animations/0/channels/0/target/node", 9, "target.node"},
      {"/animations/0/channels/0/target/path", "colour", "drive what is not read: colour"},
      {"/animations/0/channels/0/target/path", "translation", "samplers[0].output"},
      {"/animations/0/channels/1/target", {{"node", 3}, {"path", "rotation"}}, "samplers[1].output"},
      {"/animations/0/channels/1",
       {{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}},
       "driven twice"},
      {"/animations/0/channels/1/target/node", 4, "without morph targets"},
      {"/animations/0/samplers/0/interpolation", "BEZIER", "interpolation"},
      {"/animations/0/samplers/0/interpolation", "CUBICSPLINE", "samplers[0].output"},
      {"/animations/0/samplers/0/input", 6, "samplers[0].input"},
      {"/animations/0/samplers/1/output", 5, nullptr},
      {"/nodes/2/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "expected"},
  };
}

TEST(GltfValidity, EachBreachThatChangesSomethingIsSaid) {
  for (const Breach& breach : breaches()) {
    SCOPED_TRACE(std::string(breach.pointer) + " = " + breach.value.dump());
    GltfBuilder file = faultless();
    const Json::json_pointer pointer(breach.pointer);
    if (breach.value.is_null())
      file.root[pointer.parent_pointer()].erase(pointer.back());
    else
      file.root[pointer] = breach.value;
    const auto scene = file.import();
    const std::vector<std::string> sentences = scene ? scene->warnings : std::vector{scene.error().message};
    if (breach.words == nullptr) {
      EXPECT_TRUE(sentences.empty()) << joined(sentences);
      continue;
    }
    EXPECT_TRUE(contains(sentences, breach.words))
        << "expected: " << breach.words << "\nfound: " << joined(sentences);
  }
}

TEST(GltfValidity, ReferencesThatAreRepeatedAreSaidOnceForEachList) {
  GltfBuilder file = faultless();
  file.root["scenes"][0]["nodes"] = {0, 1, 4, 1, 1, 0};
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_EQ(scene->warnings,
            std::vector<std::string>{"scenes[0].nodes[3]: found 1 twice, and 2 more repeats, "
                                     "expected each once."});
}

struct DataBreach {
  std::size_t accessor;
  std::size_t byte;  ///< of its view
  std::vector<float> values;
  const char* words;
};

TEST(GltfValidity, EachBreachOfTheNumbersIsSaid) {
  const DataBreach data[] = {
      {0, 0, {NAN}, "not finite"},
      {1, 0, {0, 0, 2}, "normals not of unit length"},
      {2, 0, {0}, ""},
      {4, 0, {0.25f}, "skin weights do not sum to 1"},
      {4, 0, {-0.5f, 1.5f}, "skin weights do not sum to 1"},
      {5, 0, {-1}, "expected rising times"},
      {5, 0, {1}, "expected rising times"},
      {6, 0, {0, 0, 0, 3}, "rotations not of unit length"},
      {8, 12, {1}, "last row that is not 0 0 0 1"},
      {9, 12, {0.5f}, ""},  // tangents that no normal map reads
  };
  for (const DataBreach& breach : data) {
    SCOPED_TRACE(breach.words);
    GltfBuilder file = faultless();
    const std::size_t offset = file.root["bufferViews"][breach.accessor]["byteOffset"];
    std::memcpy(file.bytes.data() + offset + breach.byte, breach.values.data(), 4 * breach.values.size());
    const auto scene = file.import();
    const std::vector<std::string> sentences = scene ? scene->warnings : std::vector{scene.error().message};
    if (*breach.words == '\0') {
      EXPECT_TRUE(sentences.empty()) << joined(sentences);
      continue;
    }
    EXPECT_TRUE(contains(sentences, breach.words)) << joined(sentences);
  }
  GltfBuilder repeated = faultless();
  repeated.bytes[repeated.root["bufferViews"][3]["byteOffset"].get<std::size_t>() + 1] = 0;
  const auto scene = repeated.import();
  ASSERT_TRUE(scene.has_value());
  EXPECT_TRUE(contains(scene->warnings, "vertices with the same joint twice")) << joined(scene->warnings);
  GltfBuilder beyond = faultless();
  beyond.bytes[beyond.root["bufferViews"][2]["byteOffset"].get<std::size_t>()] = 3;
  EXPECT_FALSE(beyond.import().has_value());
}

TEST(GltfValidity, ABufferMayHaveAnyMediaType) {
  GltfBuilder file = faultless();
  std::string uri = "data:text/plain,";
  for (const char byte : file.bytes) uri += fmt::format("%{:02X}", static_cast<unsigned char>(byte));
  file.root["buffers"][0]["uri"] = uri;
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
  file.root["buffers"][0]["uri"] = uri + "%00";
  EXPECT_TRUE(contains(file.import()->warnings, "the others are not used"));
}

// Scenes that are bundled, and samples that the validator calls faultless, are not warned of.
TEST(GltfValidity, GoodFilesAreNotAccused) {
  const auto folder = std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes/extra/gltf";
  std::vector<std::filesystem::path> files = {std::filesystem::path(TENEBRA_SCENES_DIR) / "city.glb",
                                              std::filesystem::path(TENEBRA_SCENES_DIR) / "court.glb",
                                              std::filesystem::path(TENEBRA_SCENES_DIR) / "gallery.glb"};
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
        files.push_back(entry.path());
  for (const auto& file : files) {
    const auto scene = formats::import_gltf(file);
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    for (const char* accusation : {"expected", "found a ", "found an ", "found no "})
      EXPECT_FALSE(contains(scene->warnings, accusation)) << file << "\n" << joined(scene->warnings);
  }
}

}  // namespace
}  // namespace tenebra
