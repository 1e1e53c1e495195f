// What glTF says of surfaces: factors, textures and how they are sampled, coordinates, colours, extensions,
// and what is done where a picture is missing or broken.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/images/decode.h"
#include "formats/import_scene.h"
#include "pictures.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using Json = nlohmann::json;
using testing::png_of;
using testing::small_picture;

std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Json data_uri(const std::string& bytes, const std::string& kind = "image/png") {
  return {{"uri", "data:" + kind + ";base64," + base64(bytes)}};
}

/// Names of all extensions in `value`.
void collect_extensions(const Json& value, std::set<std::string>& names) {
  if (!value.is_structured()) return;
  for (const auto& [key, child] : value.items()) {
    if (key == "extensions" && child.is_object())
      for (const auto& [name, unused] : child.items()) names.insert(name);
    collect_extensions(child, names);
  }
}

/// A triangle with one material, whose parts tests change before they import it.
struct File {
  Json root = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}}},
               {"materials", {Json::object()}}};
  std::string bytes;
  testing::TemporaryFolder folder;

  File() {
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::size_t position = accessor(corners.data(), 36, 5126, "VEC3");
    root["accessors"][position]["min"] = {0, 0, 0};
    root["accessors"][position]["max"] = {1, 1, 0};
    for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
      attributes()[set] = accessor(corners.data(), 24, 5126, "VEC2");
  }

  Json& material() { return root["materials"][0]; }
  Json& attributes() { return root["meshes"][0]["primitives"][0]["attributes"]; }

  std::size_t view(const std::string& data) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    return root["bufferViews"].size() - 1;
  }

  /// Three elements of the type.
  std::size_t accessor(const void* data, std::size_t size, int component, const char* type,
                       bool normalized = false) {
    const std::size_t at = view(std::string(static_cast<const char*>(data), size));
    root["accessors"].push_back(
        {{"bufferView", at}, {"componentType", component}, {"count", 3}, {"type", type}});
    if (normalized) root["accessors"].back()["normalized"] = true;
    return root["accessors"].size() - 1;
  }

  /// A texture of a small picture; returns its index.
  std::size_t texture(int seed = 0, Json sampler = nullptr) {
    root["images"].push_back(data_uri(png_of(small_picture(2, 2, seed))));
    Json added = {{"source", root["images"].size() - 1}};
    if (!sampler.is_null()) {
      root["samplers"].push_back(sampler);
      added["sampler"] = root["samplers"].size() - 1;
    }
    root["textures"].push_back(added);
    return root["textures"].size() - 1;
  }

  Json& base_texture(std::size_t texture) {
    Json& info = material()["pbrMetallicRoughness"]["baseColorTexture"];
    info["index"] = texture;
    return info;
  }

  Expected<Scene> import() {
    Json whole = root;
    std::set<std::string> extensions;
    collect_extensions(root, extensions);
    if (!extensions.empty()) whole["extensionsUsed"] = extensions;
    whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "b.bin"}}};
    testing::write_text(folder / "b.bin", bytes);
    testing::write_text(folder / "a.gltf", whole.dump());
    return formats::import_gltf(folder / "a.gltf");
  }

  Scene scene() {
    auto scene = import();
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }

  /// The one material of a file that imports without a warning.
  Material read() {
    const Scene imported = scene();
    EXPECT_TRUE(imported.warnings.empty()) << imported.warnings[0];
    EXPECT_FALSE(imported.materials.empty());
    return imported.materials.empty() ? Material{} : imported.materials[0];
  }
};

/// One of the warnings says `words`.
void expect_warning(const Scene& scene, const std::string& words) {
  const auto says = [&](const std::string& warning) { return warning.find(words) != std::string::npos; };
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), says))
      << words << " in: " << fmt::format("{}", fmt::join(scene.warnings, " | "));
  for (const std::string& warning : scene.warnings) EXPECT_EQ(warning.back(), '.') << warning;
}

TEST(GltfLooks, FactorsHaveTheDefaultsOfTheFormat) {
  const Material material = File().read();
  EXPECT_EQ(material.model, SurfaceModel::metallic_roughness);
  EXPECT_EQ(material.base_color, glm::vec3(1));
  EXPECT_EQ(material.metallic, 1.0f);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.alpha, 1.0f);
  EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(material.alpha_cutoff, 0.5f);
  EXPECT_FALSE(material.double_sided);
  EXPECT_LT(material.ambient.x, 0);
}

TEST(GltfLooks, ATriangleWithoutAMaterialHasTheSame) {
  File file;
  file.root["meshes"][0]["primitives"][0].erase("material");
  const Scene scene = file.scene();
  const Material& material = scene.materials.at(scene.meshes.at(0).materials.at(0));
  EXPECT_EQ(material.model, SurfaceModel::metallic_roughness);
  EXPECT_EQ(material.metallic, 1.0f);
}

TEST(GltfLooks, FactorsAreRead) {
  File file;
  file.material() = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
      {"alphaMode", "MASK"},
      {"alphaCutoff", 0.25},
      {"doubleSided", true},
      {"emissiveFactor", {0.5, 0, 1}},
      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
  const Material material = file.read();
  EXPECT_EQ(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material.alpha, 0.4f);
  EXPECT_EQ(material.metallic, 0.5f);
  EXPECT_EQ(material.roughness, 0.6f);
  EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.emissive, glm::vec3(2, 0, 4));
}

TEST(GltfLooks, FactorsOutsideTheirRangeAreCutWithAWarning) {
  File file;
  file.material()["pbrMetallicRoughness"] = {{"metallicFactor", 3}};
  const Scene scene = file.scene();
  expect_warning(scene, "materials[0].pbrMetallicRoughness.metallicFactor");
  EXPECT_EQ(scene.materials[0].metallic, 1.0f);
}

TEST(GltfLooks, AnUnknownAlphaModeIsOpaqueWithAWarning) {
  File file;
  file.material()["alphaMode"] = "DITHER";
  expect_warning(file.scene(), "'DITHER'");
}

TEST(GltfLooks, PicturesComeFromDataUrisViewsAndFiles) {
  const std::string png = png_of(small_picture(3, 2));
  for (const int where : {0, 1, 2}) {
    SCOPED_TRACE(where);
    File file;
    file.base_texture(file.texture());
    Json& image = file.root["images"][0];
    if (where == 0) image = data_uri(png);
    if (where == 1) image = {{"bufferView", file.view(png)}, {"mimeType", "image/png"}};
    if (where == 2) {
      image = {{"uri", "a%20picture.png"}};
      testing::write_text(file.folder / "a picture.png", png);
    }
    const Scene scene = file.scene();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 3);
    EXPECT_EQ(scene.images[0].rgba, small_picture(3, 2).pixels);
    EXPECT_EQ(scene.materials[0].base_color_map.image, 0);
  }
}

TEST(GltfLooks, TexturesOfOneImageShareIt) {
  File file;
  const std::size_t first = file.texture();
  file.root["textures"].push_back({{"source", 0}});
  file.base_texture(first);
  file.material()["emissiveTexture"] = {{"index", 1}};
  file.material()["emissiveFactor"] = {1, 1, 1};
  EXPECT_EQ(file.scene().images.size(), 1u);
}

TEST(GltfLooks, OnlyPicturesThatSomethingShowsAreDecoded) {
  File file;
  file.base_texture(file.texture(0));
  file.texture(1);
  file.material()["emissiveTexture"] = {{"index", 1}};  // times a factor of 0
  EXPECT_EQ(file.scene().images.size(), 1u);
}

TEST(GltfLooks, SamplersAreRead) {
  struct Case {
    int number;
    Filter minify;
    MipFilter mip;
  };
  for (const Case& c :
       {Case{9728, Filter::nearest, MipFilter::none}, Case{9729, Filter::linear, MipFilter::none},
        Case{9984, Filter::nearest, MipFilter::nearest}, Case{9985, Filter::linear, MipFilter::nearest},
        Case{9986, Filter::nearest, MipFilter::linear}, Case{9987, Filter::linear, MipFilter::linear}}) {
    File file;
    file.base_texture(
        file.texture(0, {{"minFilter", c.number}, {"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}));
    const TextureMap map = file.read().base_color_map;
    EXPECT_EQ(map.minify, c.minify) << c.number;
    EXPECT_EQ(map.mip, c.mip) << c.number;
    EXPECT_EQ(map.magnify, Filter::nearest);
    EXPECT_EQ(map.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(map.wrap_v, Wrap::mirrored_repeat);
  }
  File file;
  file.base_texture(file.texture());
  const TextureMap map = file.read().base_color_map;
  EXPECT_EQ(map.wrap_u, Wrap::repeat);
  EXPECT_EQ(map.magnify, Filter::linear);
  EXPECT_EQ(map.mip, MipFilter::linear);
}

TEST(GltfLooks, AWrongSamplerIsAWarning) {
  File file;
  file.base_texture(file.texture(0, {{"wrapS", 1}}));
  expect_warning(file.scene(), "samplers[0].wrapS: found 1");
}

TEST(GltfLooks, TexturesAreMovedTurnedAndScaled) {
  File file;
  Json& info = file.base_texture(file.texture());
  info["texCoord"] = 0;
  info["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.25, 0.5}}, {"rotation", M_PI / 2}, {"scale", {2, 3}}, {"texCoord", 1}};
  const TextureMap map = file.read().base_color_map;
  EXPECT_EQ(map.uv_set, 1);
  // Counter-clockwise where v points down: u turns to -v, v to u.
  const glm::vec2 at_u = map.transform * glm::vec3(1, 0, 1), at_v = map.transform * glm::vec3(0, 1, 1);
  EXPECT_NEAR(at_u.x, 0.25, 1e-6);
  EXPECT_NEAR(at_u.y, 0.5 - 2, 1e-6);
  EXPECT_NEAR(at_v.x, 0.25 + 3, 1e-6);
  EXPECT_NEAR(at_v.y, 0.5, 1e-6);
}

TEST(GltfLooks, ExtensionsOfModelsAreRead) {
  File unlit;
  unlit.material()["extensions"]["KHR_materials_unlit"] = Json::object();
  EXPECT_EQ(unlit.read().model, SurfaceModel::unlit);

  File gloss;
  const std::size_t diffuse = gloss.texture(0), specular = gloss.texture(1);
  gloss.material()["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
      {"specularFactor", {0.5, 0.6, 0.7}},
      {"glossinessFactor", 0.75},
      {"diffuseTexture", {{"index", diffuse}}},
      {"specularGlossinessTexture",
       {{"index", specular}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}};
  const Material material = gloss.read();
  EXPECT_EQ(material.model, SurfaceModel::specular_glossiness);
  EXPECT_EQ(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material.alpha, 0.4f);
  EXPECT_EQ(material.specular, glm::vec3(0.5f, 0.6f, 0.7f));
  EXPECT_EQ(material.roughness, 0.25f);
  EXPECT_EQ(material.base_color_map.image, 0);
  EXPECT_EQ(material.specular_map.image, 1);
  EXPECT_EQ(material.specular_map.transform[0], glm::vec2(2, 0));
}

TEST(GltfLooks, TransmissionIsTinted) {
  File file;
  const std::size_t texture = file.texture();
  file.material()["extensions"]["KHR_materials_transmission"] = {
      {"transmissionFactor", 0.5}, {"transmissionTexture", {{"index", texture}}}};
  const Material material = file.read();
  EXPECT_EQ(material.transmission, 0.5f);
  EXPECT_TRUE(material.tinted_transmission);
  EXPECT_TRUE(material.see_through());
  EXPECT_EQ(material.transmission_map.image, 0);
}

TEST(GltfLooks, CoordinatesOfAllComponentTypesAreRead) {
  File file;
  const std::vector<float> first = {0, 0.5f, 1, -2, 3, 0.25f};
  const std::vector<std::uint8_t> second = {0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0};
  file.attributes()["TEXCOORD_0"] = file.accessor(first.data(), 24, 5126, "VEC2");
  file.attributes()["TEXCOORD_1"] = file.accessor(second.data(), 12, 5121, "VEC2", true);
  file.root["bufferViews"].back()["byteStride"] = 4;
  const Scene scene = file.scene();
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  const auto& sets = scene.meshes.at(0).texture_coordinates;
  EXPECT_EQ(sets[0], (std::vector<glm::vec2>{{0, 0.5f}, {1, -2}, {3, 0.25f}}));
  EXPECT_EQ(sets[1], (std::vector<glm::vec2>{{0, 1}, {0.2f, 0.4f}, {1, 0}}));
}

TEST(GltfLooks, ColoursOfAllComponentTypesAreRead) {
  const std::vector<float> floats = {0, 0.2f, 0.4f, 1, 1, 1, 0.6f, 0.8f, 0};
  const std::vector<std::uint8_t> bytes = {0, 51, 102, 255, 255, 255, 255, 255, 153, 204, 0, 255};
  std::vector<std::uint16_t> words;
  for (const std::uint8_t byte : bytes) words.push_back(static_cast<std::uint16_t>(byte * 257));
  for (const int component : {5126, 5121, 5123}) {
    File file;
    file.attributes()["COLOR_0"] = component == 5126   ? file.accessor(floats.data(), 36, 5126, "VEC3")
                                   : component == 5121 ? file.accessor(bytes.data(), 12, 5121, "VEC4", true)
                                                       : file.accessor(words.data(), 24, 5123, "VEC4", true);
    const Scene scene = file.scene();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_EQ(scene.meshes.at(0).colors,
              (std::vector<glm::vec4>{{0, 0.2f, 0.4f, 1}, {1, 1, 1, 1}, {0.6f, 0.8f, 0, 1}}))
        << component;
  }
}

TEST(GltfLooks, APrimitiveWithoutColoursIsWhiteBesideOneThatHasThem) {
  File file;
  for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"}) file.attributes().erase(set);
  Json plain = file.root["meshes"][0]["primitives"][0];
  const std::vector<float> colors(9, 0.5f), coordinates(6, 0.25f);
  file.attributes()["COLOR_0"] = file.accessor(colors.data(), 36, 5126, "VEC3");
  file.attributes()["TEXCOORD_1"] = file.accessor(coordinates.data(), 24, 5126, "VEC2");
  file.root["meshes"][0]["primitives"].push_back(plain);
  const Mesh mesh = file.scene().meshes.at(0);
  ASSERT_EQ(mesh.colors.size(), 6u);
  EXPECT_EQ(mesh.colors[0], glm::vec4(0.5f, 0.5f, 0.5f, 1));
  EXPECT_EQ(mesh.colors[5], glm::vec4(1));
  EXPECT_TRUE(mesh.texture_coordinates[0].empty());
  ASSERT_EQ(mesh.texture_coordinates[1].size(), 6u);
  EXPECT_EQ(mesh.texture_coordinates[1][5], glm::vec2(0));
}

TEST(GltfLooks, FaultsOfAttributesAreWarnings) {
  File file;
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
    File file;
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
  File file;
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
  File file;
  file.texture(0);
  file.base_texture(file.texture(1));
  file.root["images"][0] = Json::object();
  const Scene scene = file.scene();
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].name, "images[1]");
  EXPECT_EQ(scene.images[0].rgba, small_picture(2, 2, 1).pixels);
}

TEST(GltfLooks, AReferenceToNoTextureCostsTheTextureAlone) {
  File file;
  file.base_texture(5);
  expect_warning(file.scene(), "found reference 5");
  File coordinates;
  coordinates.base_texture(coordinates.texture())["texCoord"] = 2;
  expect_warning(coordinates.scene(), "found TEXCOORD_2");
}

TEST(GltfLooks, WebpIsReadOrWhatStandsBesideIt) {
  File file;
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
  File file;
  file.base_texture(file.texture());
  file.root["images"].push_back(data_uri("\xABKTX 20\xBB", "image/ktx2"));
  file.root["textures"][0]["extensions"]["KHR_texture_basisu"] = {{"source", 1}};
  EXPECT_TRUE(file.scene().materials.at(0).base_color_map);
  file.root["textures"][0].erase("source");
  expect_warning(file.scene(), "textures[0] in KTX2 alone");
}

TEST(GltfLooks, WhatIsNotUsedIsCountedAndNamedOnce) {
  File file;
  const std::size_t texture = file.texture();
  file.material() = {{"normalTexture", {{"index", texture}}},
                     {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}};
  file.root["materials"].push_back(file.material());
  const Scene scene = file.scene();
  ASSERT_EQ(scene.unused.size(), 2u);
  EXPECT_EQ(scene.unused[0].name, "KHR_materials_clearcoat");
  EXPECT_EQ(scene.unused[0].count, 2u);
  EXPECT_EQ(scene.unused[1].name, "normalTexture");
  expect_warning(scene, "normalTexture: found in 2 materials");
  expect_warning(scene, "KHR_materials_clearcoat: found in 2 materials");
  EXPECT_EQ(scene.extensions, (std::vector<std::string>{"KHR_materials_clearcoat"}));
  EXPECT_TRUE(scene.images.empty());
}

TEST(GltfLooks, ABombIsRefusedByItsHeader) {
  File file;
  file.base_texture(file.texture());
  std::string jpeg = testing::jpeg_of(small_picture(8, 8));
  const std::size_t frame = jpeg.find("\xff\xc0");
  for (const std::size_t at : {frame + 5, frame + 7}) jpeg[at] = '\xff';
  file.root["images"][0] = data_uri(jpeg, "image/jpeg");
  expect_warning(file.scene(), "65288 x 65288 pixels, expected at most 67108864");
}

/// Looks may hold anything: each value of them replaced by each of several others imports or is refused.
TEST(GltfLooks, OddValuesNeverCrash) {
  File file;
  Json& info = file.base_texture(file.texture(0, {{"wrapS", 33071}, {"minFilter", 9984}}));
  info["extensions"]["KHR_texture_transform"] = {{"offset", {0, 1}}, {"rotation", 1}, {"texCoord", 0}};
  file.material()["extensions"] = {
      {"KHR_materials_unlit", Json::object()},
      {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
      {"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 1, 1, 1}}}}};
  file.root["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 0}};
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

}  // namespace
}  // namespace tenebra
