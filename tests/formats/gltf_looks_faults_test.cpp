// What is done where glTF says something of surfaces that is wrong, missing, broken or not used.
#include <gtest/gtest.h>

#include "gltf_looks_file.h"

namespace tenebra {
namespace {

using testing::data_uri;
using testing::expect_warning;
using testing::Json;
using testing::LooksFile;
using testing::png_of;
using testing::small_picture;

TEST(GltfLooks, FactorsOutsideTheirRangeAreCutWithAWarning) {
  LooksFile file;
  file.material()["pbrMetallicRoughness"] = {{"metallicFactor", 3}};
  const Scene scene = file.scene();
  expect_warning(scene, "materials[0].pbrMetallicRoughness.metallicFactor");
  EXPECT_EQ(scene.materials[0].metallic, 1.0f);
}

TEST(GltfLooks, AnUnknownAlphaModeIsOpaqueWithAWarning) {
  LooksFile file;
  file.material()["alphaMode"] = "DITHER";
  expect_warning(file.scene(), "'DITHER'");
}

TEST(GltfLooks, AWrongSamplerIsAWarning) {
  LooksFile file;
  file.base_texture(file.texture(0, {{"wrapS", 1}}));
  expect_warning(file.scene(), "samplers[0].wrapS: found 1");
}

TEST(GltfLooks, FaultsOfAttributesAreWarnings) {
  LooksFile file;
  const std::vector<float> values(12, 0.5f), bright(9, 2.0f);
  file.attributes()["TEXCOORD_0"] = file.accessor(values.data(), 36, 5126, "VEC3");
  expect_warning(file.scene(), "TEXCOORD_0: found accessors[3] of another type");
  file.attributes().erase("TEXCOORD_0");
  file.attributes()["COLOR_0"] = file.accessor(bright.data(), 36, 5126, "VEC3");
  const Scene scene = file.scene();
  expect_warning(scene, "COLOR_0: found 9 values outside 0 to 1");
  EXPECT_EQ(scene.meshes[0].colors[0], glm::vec4(1));
}

TEST(GltfLooks, APictureThatCannotBeReadCostsItsTextureAlone) {
  struct Case {
    Json image;
    std::string words;
  };
  const std::string png = png_of(small_picture(2, 2));
  for (const Case& c : {Case{{{"uri", "missing.png"}}, "missing.png"},
                        Case{{{"uri", "../b.bin"}}, "images[0].uri: found '../b.bin'"},
                        Case{{{"uri", "/etc/passwd"}}, "'/etc/passwd'"},
                        Case{{{"uri", "http://example.org/a.png"}}, "http://example.org/a.png"},
                        Case{data_uri(png.substr(0, 30)), "images[0]"},
                        Case{{{"uri", "data:image/png;base64,!"}}, "outside base64"},
                        Case{data_uri("\xABKTX 20\xBB", "image/ktx2"), "KTX2"},
                        Case{Json::object(), "neither uri nor bufferView"},
                        Case{{{"bufferView", 77}}, "found reference 77"}}) {
    SCOPED_TRACE(c.words);
    LooksFile file;
    file.base_texture(file.texture());
    file.root["images"][0] = c.image;
    file.material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 0, 1};
    const Scene scene = file.scene();
    expect_warning(scene, c.words);
    EXPECT_FALSE(scene.materials[0].base_color_map);
    EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1, 0, 0));
    EXPECT_TRUE(scene.images.empty());
  }
}

TEST(GltfLooks, WithoutThePictureOfItsEmissionNothingShines) {
  LooksFile file;
  file.texture();
  file.root["images"][0] = {{"uri", "missing.png"}};
  file.material()["emissiveTexture"] = {{"index", 0}};
  file.material()["emissiveFactor"] = {1, 1, 1};
  const Scene scene = file.scene();
  expect_warning(scene, "missing.png");
  expect_warning(scene, "materials[0].emissiveTexture: without its picture the surface does not shine.");
  EXPECT_EQ(scene.materials[0].emissive, glm::vec3(0));
}

TEST(GltfLooks, ABrokenEntryLeavesTheNumbersOfThoseAfterIt) {
  LooksFile file;
  file.texture(0);
  file.base_texture(file.texture(1));
  file.root["images"][0] = Json::object();
  const Scene scene = file.scene();
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].name, "images[1]");
  EXPECT_EQ(scene.images[0].rgba, small_picture(2, 2, 1).pixels);
}

TEST(GltfLooks, AReferenceToNoTextureCostsTheTextureAlone) {
  LooksFile file;
  file.base_texture(5);
  expect_warning(file.scene(), "found reference 5");
  LooksFile coordinates;
  coordinates.base_texture(coordinates.texture())["texCoord"] = 2;
  expect_warning(coordinates.scene(), "found TEXCOORD_2");
}

TEST(GltfLooks, ATextureWithoutCoordinatesIsSaid) {
  LooksFile file;
  file.base_texture(file.texture());
  EXPECT_TRUE(file.scene().warnings.empty());
  file.attributes().erase("TEXCOORD_0");
  expect_warning(file.scene(), "meshes[0]: found 1 primitives without the texture coordinates");
}

TEST(GltfLooks, WebpIsReadOrWhatStandsBesideIt) {
  LooksFile file;
  file.base_texture(file.texture());
  file.root["images"].push_back(data_uri("RIFF....WEBPVP8 broken", "image/webp"));
  file.root["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
  const Scene beside = file.scene();
  EXPECT_EQ(beside.images.size(), 1u);
  EXPECT_TRUE(beside.materials[0].base_color_map);
  file.root["textures"][0].erase("source");
  const Scene alone = file.scene();
  expect_warning(alone, "WebP");
  EXPECT_FALSE(alone.materials[0].base_color_map);
}

TEST(GltfLooks, BasisIsReplacedByWhatStandsBesideItOrNamed) {
  LooksFile file;
  file.base_texture(file.texture());
  file.root["images"].push_back(data_uri("\xABKTX 20\xBB", "image/ktx2"));
  file.root["textures"][0]["extensions"]["KHR_texture_basisu"] = {{"source", 1}};
  EXPECT_TRUE(file.scene().materials.at(0).base_color_map);
  file.root["textures"][0].erase("source");
  expect_warning(file.scene(), "KTX2");
}

TEST(GltfLooks, WhatIsNotUsedIsCountedAndNoWarning) {
  LooksFile file;
  file.material()["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
  file.root["materials"].push_back(file.material());
  const Scene scene = file.scene();
  ASSERT_EQ(scene.unused.size(), 1u);
  EXPECT_EQ(scene.unused[0].name, "KHR_materials_clearcoat");
  EXPECT_EQ(scene.unused[0].count, 2u);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_EQ(scene.extensions, (std::vector<std::string>{"KHR_materials_clearcoat"}));
}

TEST(GltfLooks, AnImpossibleIndexOfRefractionIsReplaced) {
  LooksFile file;
  file.material()["extensions"]["KHR_materials_ior"] = {{"ior", 0.5}};
  const Scene scene = file.scene();
  expect_warning(scene, "ior: found 0.5, expected 0 or at least 1; 1.5 is used.");
  EXPECT_EQ(scene.materials[0].dielectric, glm::vec3(0.04f));
}

TEST(GltfLooks, OddTangentsAreMadeUnitAndSaid) {
  LooksFile file;
  file.material()["normalTexture"] = {{"index", file.texture()}};
  const std::vector<float> up = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  const std::vector<float> along = {2, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, -0.5f};
  file.attributes()["NORMAL"] = file.accessor(up.data(), 36, 5126, "VEC3");
  file.attributes()["TANGENT"] = file.accessor(along.data(), 48, 5126, "VEC4");
  const Scene scene = file.scene();
  expect_warning(scene, "meshes[0]: found 3 tangents not of unit length or with a sign other than 1 and -1");
  EXPECT_EQ(scene.meshes[0].tangents, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 0, 0, 0}, {0, 1, 0, -1}}));
  file.attributes()["TANGENT"] = file.attributes()["NORMAL"];
  const Scene other = file.scene();
  expect_warning(other, "TANGENT: found accessors[3] of another type");
  EXPECT_TRUE(other.meshes[0].tangents.empty());
}

TEST(GltfLooks, ABombIsRefusedByItsHeader) {
  LooksFile file;
  file.base_texture(file.texture());
  std::string jpeg = testing::jpeg_of(small_picture(8, 8));
  const std::size_t frame = jpeg.find("\xff\xc0");
  for (const std::size_t at : {frame + 5, frame + 7}) jpeg[at] = '\xff';
  file.root["images"][0] = data_uri(jpeg, "image/jpeg");
  expect_warning(file.scene(), "65288 x 65288 pixels, expected at most 67108864");
}

/// Looks may hold anything: each value of them replaced by each of several others imports or is refused.
void try_odd_values(LooksFile& file) {
  const Json whole = file.root;
  const Json odd[] = {nullptr, true, -1, 1e300, 4294967296.0, "text", Json::array(), Json::object(), {1, 2}};
  const Json flat = whole.flatten();
  std::size_t tried = 0;
  for (const auto& [path, unused] : flat.items()) {
    const bool looks = path.starts_with("/materials") || path.starts_with("/textures") ||
                       path.starts_with("/images") || path.starts_with("/samplers");
    if (!looks) continue;
    for (Json::json_pointer at(path); !at.empty(); at.pop_back())
      for (const Json& value : odd) {
        file.root = whole;
        file.root[at] = value;
        const auto scene = file.import();
        if (!scene) {
          EXPECT_EQ(scene.error().message.find("fault ("), std::string::npos) << scene.error().message;
        }
        ++tried;
      }
  }
  EXPECT_GT(tried, 500u);
}

TEST(GltfLooks, OddValuesNeverCrash) {
  LooksFile file;
  Json& info = file.base_texture(file.texture(0, {{"wrapS", 33071}, {"minFilter", 9984}}));
  info["extensions"]["KHR_texture_transform"] = {{"offset", {0, 1}}, {"rotation", 1}, {"texCoord", 0}};
  file.material()["extensions"] = {
      {"KHR_materials_unlit", Json::object()},
      {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
      {"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 1, 1, 1}}}}};
  file.root["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 0}};
  try_odd_values(file);
}

TEST(GltfLooks, OddValuesOfReliefAndReflectanceNeverCrash) {
  LooksFile file;
  const Json info = {{"index", file.texture()}};
  file.material() = {
      {"normalTexture", info},
      {"occlusionTexture", info},
      {"extensions",
       {{"KHR_materials_ior", {{"ior", 1.3}}},
        {"KHR_materials_specular",
         {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0, 1}}, {"specularTexture", info}}}}},
      {"extras", {{"model", "phong"}, {"specular_texture", info}}}};
  file.material()["normalTexture"]["scale"] = 2;
  file.material()["occlusionTexture"]["strength"] = 0.5;
  try_odd_values(file);
}

}  // namespace
}  // namespace tenebra
