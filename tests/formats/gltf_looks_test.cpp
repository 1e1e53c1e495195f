// What glTF says of surfaces: factors, textures and how they are sampled, coordinates, colours, extensions.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_looks_file.h"

namespace tenebra {
namespace {

using testing::data_uri;
using testing::Json;
using testing::LooksFile;
using testing::png_of;
using testing::small_picture;

TEST(GltfLooks, FactorsHaveTheDefaultsOfTheFormat) {
  const Material material = LooksFile().read();
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
  LooksFile file;
  file.root["meshes"][0]["primitives"][0].erase("material");
  const Scene scene = file.scene();
  const Material& material = scene.materials.at(scene.meshes.at(0).materials.at(0));
  EXPECT_EQ(material.model, SurfaceModel::metallic_roughness);
  EXPECT_EQ(material.metallic, 1.0f);
}

TEST(GltfLooks, FactorsAreRead) {
  LooksFile file;
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

TEST(GltfLooks, PicturesComeFromDataUrisViewsAndFiles) {
  const std::string png = png_of(small_picture(3, 2));
  for (const int where : {0, 1, 2}) {
    SCOPED_TRACE(where);
    LooksFile file;
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
  LooksFile file;
  const std::size_t first = file.texture();
  file.root["textures"].push_back({{"source", 0}});
  file.base_texture(first);
  file.material()["emissiveTexture"] = {{"index", 1}};
  file.material()["emissiveFactor"] = {1, 1, 1};
  EXPECT_EQ(file.scene().images.size(), 1u);
}

TEST(GltfLooks, OnlyPicturesThatSomethingShowsAreDecoded) {
  LooksFile file;
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
    LooksFile file;
    file.base_texture(
        file.texture(0, {{"minFilter", c.number}, {"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}));
    const TextureMap map = file.read().base_color_map;
    EXPECT_EQ(map.minify, c.minify) << c.number;
    EXPECT_EQ(map.mip, c.mip) << c.number;
    EXPECT_EQ(map.magnify, Filter::nearest);
    EXPECT_EQ(map.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(map.wrap_v, Wrap::mirrored_repeat);
  }
  LooksFile file;
  file.base_texture(file.texture());
  const TextureMap map = file.read().base_color_map;
  EXPECT_EQ(map.wrap_u, Wrap::repeat);
  EXPECT_EQ(map.magnify, Filter::linear);
  EXPECT_EQ(map.mip, MipFilter::linear);
}

TEST(GltfLooks, TexturesAreMovedTurnedAndScaled) {
  LooksFile file;
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
  LooksFile unlit;
  unlit.material()["extensions"]["KHR_materials_unlit"] = Json::object();
  EXPECT_EQ(unlit.read().model, SurfaceModel::unlit);

  LooksFile gloss;
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
  LooksFile file;
  const std::size_t texture = file.texture();
  file.material()["extensions"]["KHR_materials_transmission"] = {
      {"transmissionFactor", 0.5}, {"transmissionTexture", {{"index", texture}}}};
  const Material material = file.read();
  EXPECT_EQ(material.transmission, 0.5f);
  EXPECT_TRUE(material.tinted_transmission);
  EXPECT_TRUE(material.see_through());
  EXPECT_EQ(material.transmission_map.image, 0);
}

TEST(GltfLooks, NormalAndOcclusionMapsAreRead) {
  LooksFile file;
  const std::size_t bumps = file.texture(0), folds = file.texture(1);
  file.material()["normalTexture"] = {
      {"index", bumps}, {"scale", 0.25}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}};
  file.material()["occlusionTexture"] = {{"index", folds}, {"strength", 0.5}, {"texCoord", 1}};
  const Material material = file.read();
  EXPECT_EQ(material.normal_map.image, 0);
  EXPECT_EQ(material.normal_map.uv_set, 1);
  EXPECT_EQ(material.normal_scale, 0.25f);
  EXPECT_EQ(material.occlusion_map.image, 1);
  EXPECT_EQ(material.occlusion_map.uv_set, 1);
  EXPECT_EQ(material.occlusion_strength, 0.5f);
  file.material()["extensions"]["KHR_materials_unlit"] = Json::object();
  EXPECT_FALSE(file.read().normal_map);
}

TEST(GltfLooks, TangentsAreReadWhereANormalMapUsesThem) {
  LooksFile file;
  const std::vector<float> up = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  const std::vector<float> along = {1, 0, 0, 1, 0, 1, 0, -1, 1, 0, 0, 1};
  file.attributes()["NORMAL"] = file.accessor(up.data(), 36, 5126, "VEC3");
  file.attributes()["TANGENT"] = file.accessor(along.data(), 48, 5126, "VEC4");
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"TANGENT", file.attributes()["NORMAL"]}}};
  const Mesh without = file.scene().meshes.at(0);
  EXPECT_TRUE(without.tangents.empty());
  EXPECT_TRUE(without.morph_targets.at(0).tangents.empty());
  file.material()["normalTexture"] = {{"index", file.texture()}};
  const Mesh mesh = file.scene().meshes.at(0);
  EXPECT_EQ(mesh.tangents, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, -1}, {1, 0, 0, 1}}));
  EXPECT_EQ(mesh.morph_targets.at(0).tangents, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  file.attributes().erase("NORMAL");  // glTF: tangents without normals are ignored
  EXPECT_TRUE(file.scene().meshes.at(0).tangents.empty());
}

TEST(GltfLooks, ReflectanceOfWhatIsNoMetalIsRead) {
  LooksFile file;
  file.material()["extensions"]["KHR_materials_ior"] = {{"ior", 1.5}};
  EXPECT_EQ(file.read().dielectric, glm::vec3(0.04f));
  file.material()["extensions"]["KHR_materials_ior"] = {{"ior", 0}};
  EXPECT_EQ(file.read().dielectric, glm::vec3(1));
  const std::size_t share = file.texture(0), color = file.texture(1);
  file.material()["extensions"] = {{"KHR_materials_ior", {{"ior", 2}}},
                                   {"KHR_materials_specular",
                                    {{"specularFactor", 0.5},
                                     {"specularColorFactor", {0, 1, 9}},
                                     {"specularTexture", {{"index", share}}},
                                     {"specularColorTexture", {{"index", color}}}}}};
  const Material material = file.read();
  EXPECT_NEAR(glm::length(material.dielectric - glm::vec3(0, 1, 9) / 9.0f), 0, 1e-6);
  EXPECT_EQ(material.specular_share, 0.5f);
  EXPECT_EQ(material.specular_map.image, 0);  // in the order in which they are read
  EXPECT_EQ(material.specular_share_map.image, 1);
}

TEST(GltfLooks, CoordinatesOfAllComponentTypesAreRead) {
  LooksFile file;
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
    LooksFile file;
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
  LooksFile file;
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

}  // namespace
}  // namespace tenebra
