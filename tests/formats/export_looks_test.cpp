// Surfaces through export_glb and back: all models, textures with all they have, coordinates, colours.
#include <gtest/gtest.h>

#include <filesystem>

#include "pictures.h"
#include "round_trip.h"
#include "support/bart.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using testing::RoundTrip;

TextureImage image_of(const std::string& name, const io::Image8& picture) {
  TextureImage image;
  image.name = name;
  image.width = picture.width;
  image.height = picture.height;
  image.rgba = picture.pixels;
  return image;
}

/// A triangle with both sets of coordinates and colours.
Scene coloured_triangle() {
  Scene scene;
  Mesh mesh;
  mesh.name = "triangle";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  mesh.texture_coordinates = {{{{0, 0.1f}, {1, 2}, {-3, 4}}, {{5, 6}, {7, 8}, {9, 10}}}};
  mesh.colors = {{1, 0.5f, 0.25f, 1}, {0, 0, 0, 0}, {1, 1, 1, 0.1f}};
  scene.meshes.push_back(mesh);
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.images = {image_of("solid", testing::small_picture(3, 2)),
                  image_of("clear", testing::small_picture(2, 4, 5))};
  for (std::size_t i = 3; i < scene.images[0].rgba.size(); i += 4) scene.images[0].rgba[i] = 255;
  return scene;
}

void expect_same(const TextureMap& a, const TextureMap& b) {
  EXPECT_EQ(a.image, b.image);
  if (!a || !b) return;
  EXPECT_EQ(a.uv_set, b.uv_set);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 2; ++r) EXPECT_NEAR(a.transform[c][r], b.transform[c][r], 1e-6);
  EXPECT_EQ(a.wrap_u, b.wrap_u);
  EXPECT_EQ(a.wrap_v, b.wrap_v);
  EXPECT_EQ(a.magnify, b.magnify);
  EXPECT_EQ(a.minify, b.minify);
  EXPECT_EQ(a.mip, b.mip);
}

void expect_same(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.base_color, b.base_color);
  EXPECT_EQ(a.ambient, b.ambient);
  EXPECT_EQ(a.emissive, b.emissive);
  EXPECT_EQ(a.casts_shadow, b.casts_shadow);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.specular, b.specular);
  EXPECT_EQ(a.phong_exponent, b.phong_exponent);
  EXPECT_EQ(a.metallic, b.metallic);
  if (a.model != SurfaceModel::phong) {
    EXPECT_NEAR(a.roughness, b.roughness, 1e-7);
  }
  EXPECT_EQ(a.double_sided, b.double_sided);
  EXPECT_EQ(a.alpha_mode, b.alpha_mode);
  EXPECT_EQ(a.alpha, b.alpha);
  EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
  EXPECT_EQ(a.transmission, b.transmission);
  EXPECT_EQ(a.tinted_transmission, b.tinted_transmission);
  expect_same(a.base_color_map, b.base_color_map);
  expect_same(a.emissive_map, b.emissive_map);
  expect_same(a.metallic_roughness_map, b.metallic_roughness_map);
  expect_same(a.specular_map, b.specular_map);
  expect_same(a.transmission_map, b.transmission_map);
  expect_same(a.specular_share_map, b.specular_share_map);
  expect_same(a.exponent_map, b.exponent_map);
  expect_same(a.normal_map, b.normal_map);
  expect_same(a.occlusion_map, b.occlusion_map);
  EXPECT_EQ(a.normal_scale, b.normal_scale);
  EXPECT_EQ(a.occlusion_strength, b.occlusion_strength);
  EXPECT_EQ(a.specular_share, b.specular_share);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.dielectric[c], b.dielectric[c], 1e-7);
}

/// As it went, without a warning.
RoundTrip clean_round_trip(const Scene& scene) {
  RoundTrip trip = testing::round_trip(scene);
  EXPECT_TRUE(trip.back.warnings.empty()) << trip.back.warnings[0];
  return trip;
}

/// The maps of a material, to give their pictures other numbers.
std::vector<TextureMap*> maps_of(Material& material) {
  return {&material.base_color_map, &material.emissive_map,     &material.metallic_roughness_map,
          &material.specular_map,   &material.transmission_map, &material.specular_share_map,
          &material.exponent_map,   &material.normal_map,       &material.occlusion_map};
}

/// `material` with the numbers that its pictures have in `other`. They are written as they are first used.
Material renumbered(Material material, const Scene& scene, const Scene& other) {
  for (TextureMap* map : maps_of(material)) {
    if (!*map) continue;
    const TextureImage& wanted = scene.images[static_cast<std::size_t>(map->image)];
    map->image = -2;
    for (std::size_t k = 0; k < other.images.size(); ++k)
      if (other.images[k].name == wanted.name && other.images[k].rgba == wanted.rgba)
        map->image = static_cast<int>(k);
  }
  return material;
}

Material expect_back(const Material& material, std::vector<std::string>* losses = nullptr) {
  Scene scene = coloured_triangle();
  scene.materials = {material};
  RoundTrip trip = clean_round_trip(scene);
  expect_same(renumbered(material, scene, trip.back), trip.back.materials.at(0));
  if (losses) *losses = trip.losses;
  return trip.back.materials.at(0);
}

Material metal() {
  Material material;
  material.name = "metal";
  material.model = SurfaceModel::metallic_roughness;
  material.base_color = {0.1f, 0.2f, 0.3f};
  material.metallic = 0.7f;
  material.roughness = 0.4f;
  material.double_sided = false;
  return material;
}

TEST(ExportLooks, MetallicRoughnessComesBack) {
  Material material = metal();
  material.base_color_map.image = 0;
  material.metallic_roughness_map.image = 1;
  material.emissive = {3, 2, 1};
  material.emissive_map.image = 0;
  material.casts_shadow = false;
  expect_back(material);
}

TEST(ExportLooks, PhongComesBackAndOthersAreToldOfIt) {
  Material material;
  material.base_color = {2, 0.5f, 0};
  material.ambient = {0.1f, 0, 0.3f};
  material.specular = {0.2f, 1.5f, 0};
  material.phong_exponent = 25;
  material.transmission = 0.85f;
  material.base_color_map.image = 1;
  std::vector<std::string> losses;
  expect_back(material, &losses);
  ASSERT_EQ(losses.size(), 3u);
  EXPECT_NE(losses[0].find("more than 1"), std::string::npos);
  EXPECT_NE(losses[1].find("Phong"), std::string::npos);
  EXPECT_NE(losses[2].find("tint"), std::string::npos);
}

TEST(ExportLooks, ReliefAndReflectanceComeBack) {
  Material material = metal();
  material.normal_map.image = 0;
  material.normal_scale = 0.5f;
  material.occlusion_map.image = 1;
  material.occlusion_strength = 0.25f;
  material.dielectric = {0.1f, 0.02f, 0.5f};
  material.specular_share = 0.75f;
  material.specular_map.image = 1;
  material.specular_share_map.image = 0;
  expect_back(material);
  Material phong;
  phong.specular = glm::vec3(0.5f);
  phong.phong_exponent = 40;
  phong.specular_map.image = 0;
  phong.exponent_map.image = 1;
  phong.normal_map.image = 1;
  expect_back(phong);
}

TEST(ExportLooks, TangentsComeBackWhereAllVerticesHaveThem) {
  Scene scene = coloured_triangle();
  scene.materials = {metal()};
  scene.materials[0].normal_map.image = 0;
  Mesh& mesh = scene.meshes[0];
  mesh.normals.assign(3, {0, 0, 1});
  mesh.tangents = {{1, 0, 0, 1}, {0, 1, 0, -1}, {-1, 0, 0, 1}};
  EXPECT_EQ(clean_round_trip(scene).back.meshes[0].tangents, mesh.tangents);
  mesh.tangents[1] = glm::vec4(0);
  EXPECT_TRUE(clean_round_trip(scene).back.meshes[0].tangents.empty());
}

TEST(ExportLooks, SpecularGlossinessAndUnlitComeBack) {
  Material gloss;
  gloss.model = SurfaceModel::specular_glossiness;
  gloss.base_color = {0.1f, 0.2f, 0.3f};
  gloss.specular = {0.4f, 0.5f, 0.6f};
  gloss.roughness = 0.35f;
  gloss.base_color_map.image = 0;
  gloss.specular_map.image = 1;
  gloss.specular_map.uv_set = 1;
  expect_back(gloss);
  Material unlit = metal();
  unlit.model = SurfaceModel::unlit;
  unlit.metallic = 1;
  unlit.roughness = 1;
  unlit.base_color_map.image = 1;
  expect_back(unlit);
}

TEST(ExportLooks, AlphaAndTintedTransmissionComeBack) {
  Material mask = metal();
  mask.alpha_mode = AlphaMode::mask;
  mask.alpha = 0.9f;
  mask.alpha_cutoff = 0.3f;
  mask.base_color_map.image = 1;
  mask.double_sided = true;
  expect_back(mask);
  Material blend = metal();
  blend.alpha_mode = AlphaMode::blend;
  blend.alpha = 0.25f;
  expect_back(blend);
  Material glass = metal();
  glass.transmission = 0.5f;
  glass.tinted_transmission = true;
  glass.transmission_map.image = 1;
  std::vector<std::string> losses;
  expect_back(glass, &losses);
  EXPECT_TRUE(losses.empty()) << losses[0];
}

TEST(ExportLooks, EverySamplerComesBack) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat})
    for (const Filter filter : {Filter::nearest, Filter::linear})
      for (const MipFilter mip : {MipFilter::none, MipFilter::nearest, MipFilter::linear}) {
        Material material = metal();
        TextureMap& map = material.base_color_map;
        map.image = 0;
        map.wrap_v = wrap;
        map.minify = filter;
        map.magnify = filter == Filter::nearest ? Filter::linear : Filter::nearest;
        map.mip = mip;
        expect_back(material);
      }
}

TEST(ExportLooks, TransformsComeBack) {
  for (const double turn : {0.0, 0.3, -2.0, 3.14159})
    for (const glm::vec2 scale : {glm::vec2(1, 1), glm::vec2(2, -3), glm::vec2(-0.5f, 0.25f)}) {
      Material material = metal();
      const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
      material.base_color_map.image = 0;
      material.base_color_map.uv_set = 1;
      material.base_color_map.transform = {scale.x * glm::vec2(c, -s), scale.y * glm::vec2(s, c),
                                           glm::vec2(0.5f, 7)};
      expect_back(material);
    }
}

TEST(ExportLooks, ASkewedTransformIsNamed) {
  Scene scene = coloured_triangle();
  scene.materials = {metal()};
  scene.materials[0].base_color_map.image = 0;
  scene.materials[0].base_color_map.transform = {1, 0, 1, 1, 0, 0};
  const RoundTrip trip = clean_round_trip(scene);
  ASSERT_EQ(trip.losses.size(), 1u);
  EXPECT_NE(trip.losses[0].find("skewed"), std::string::npos);
}

TEST(ExportLooks, PicturesCoordinatesAndColoursComeBack) {
  Scene scene = coloured_triangle();
  scene.materials = {metal()};
  scene.materials[0].base_color_map.image = 0;
  scene.materials[0].metallic_roughness_map.image = 1;
  const RoundTrip trip = clean_round_trip(scene);
  ASSERT_EQ(trip.back.images.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(trip.back.images[i].name, scene.images[i].name);
    EXPECT_EQ(trip.back.images[i].rgba, scene.images[i].rgba);
  }
  EXPECT_EQ(trip.back.meshes[0].texture_coordinates, scene.meshes[0].texture_coordinates);
  EXPECT_EQ(trip.back.meshes[0].colors, scene.meshes[0].colors);
  EXPECT_TRUE(trip.losses.empty()) << trip.losses[0];
}

TEST(ExportLooks, TheSecondSetAloneComesBackAsTheSecond) {
  Scene scene = coloured_triangle();
  scene.materials = {metal()};
  scene.meshes[0].texture_coordinates[0].clear();
  const RoundTrip trip = clean_round_trip(scene);
  EXPECT_EQ(trip.back.meshes[0].texture_coordinates[1], scene.meshes[0].texture_coordinates[1]);
}

TEST(ExportLooks, DisplayValuesComeBackAndAreLinearForOthers) {
  Scene scene = coloured_triangle();
  scene.materials = {metal()};
  scene.materials[0].base_color = {0.5f, 0, 1};
  scene.transfer = Transfer::display;
  const RoundTrip trip = clean_round_trip(scene);
  EXPECT_EQ(trip.back.transfer, Transfer::display);
  EXPECT_EQ(trip.back.materials[0].base_color, glm::vec3(0.5f, 0, 1));
  const auto& factor = trip.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_NEAR(factor[0].get<double>(), 0.21404, 1e-5);
  ASSERT_EQ(trip.losses.size(), 1u);
  EXPECT_NE(trip.losses[0].find("display"), std::string::npos);
}

/// Whole scenes: every triangle has the material, and every corner the coordinates, that it had.
class ExportLooksOfScenes : public ::testing::TestWithParam<const char*> {};

/// What each triangle shows, in an order that export does not keep.
std::vector<std::string> triangles_of(const Scene& scene) {
  std::vector<std::string> list;
  for (const Mesh& mesh : scene.meshes)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Material& material = scene.materials[mesh.materials[t]];
      std::string text = material.name;
      if (material.base_color_map) {
        text += " " + scene.images[static_cast<std::size_t>(material.base_color_map.image)].name;
        for (int c = 0; c < 3; ++c) {
          const glm::vec2 uv = mesh.texture_coordinates[0][mesh.triangles[t][c]];
          text += " " + std::to_string(uv.x) + " " + std::to_string(uv.y);
        }
      }
      list.push_back(std::move(text));
    }
  std::sort(list.begin(), list.end());
  return list;
}

TEST_P(ExportLooksOfScenes, ComeBack) {
  const std::string name = GetParam();
  const fs::path file =
      name.ends_with(".aff") ? testing::bart_folder() / name : fs::path(TENEBRA_SHARED_DIR) / "scenes" / name;
  // Models of others have licences of their own: they lie beside the checkout, not in it.
  if (!fs::exists(file)) GTEST_SKIP() << "The scenes are not at " << file << ".";
  const auto scene = formats::import_scene(file);
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  const RoundTrip trip = clean_round_trip(*scene);
  EXPECT_EQ(trip.back.transfer, scene->transfer);
  ASSERT_EQ(trip.back.images.size(), scene->images.size());
  ASSERT_GE(trip.back.materials.size(), scene->materials.size());
  for (std::size_t i = 0; i < scene->materials.size(); ++i) {
    SCOPED_TRACE(scene->materials[i].name);
    expect_same(renumbered(scene->materials[i], *scene, trip.back), trip.back.materials[i]);
    if (HasFailure()) return;
  }
  EXPECT_EQ(triangles_of(*scene), triangles_of(trip.back));
}

INSTANTIATE_TEST_SUITE_P(Shared, ExportLooksOfScenes,
                         ::testing::Values("robots/Robot.aff", "kitchen/kitchen.aff", "museum/museum5.aff",
                                           "extra/gltf/CesiumMan.glb", "extra/gltf/Lantern/Lantern.gltf",
                                           "extra/gltf/HotelRoom.glb",
                                           "extra/gltf/JapaneseBridgeGarden.glb"));

}  // namespace
}  // namespace tenebra
