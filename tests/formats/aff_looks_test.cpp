// What AFF says of surfaces: pictures and where they are found, gloss, transmittance, display values.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "formats/import_scene.h"
#include "pictures.h"
#include "support/bart.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using testing::ppm_of;
using testing::write_text;

/// A triangle with a picture.
std::string textured(const std::string& picture) {
  return "tt " + picture + " 0 0 0 0 1  1 0 0 1 1  0 1 0 0 0\n";
}

class AffLooks : public ::testing::Test {
protected:
  AffLooks() { fs::create_directories(folder_ / "scene"); }

  void put(const std::string& name, const std::string& bytes) const {
    fs::create_directories((folder_ / name).parent_path());
    write_text(folder_ / name, bytes);
  }
  Scene read(const std::string& text, const formats::ImportOptions& options = {}) const {
    put("scene/a.aff", text);
    auto scene = formats::import_aff(folder_ / "scene/a.aff", options);
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  static const Material& material_of(const Scene& scene, std::size_t mesh = 0) {
    return scene.materials.at(scene.meshes.at(mesh).materials.at(0));
  }

  testing::TemporaryFolder folder_;
};

TEST_F(AffLooks, ColoursAreDisplayValues) {
  EXPECT_EQ(read("f 1 1 1 1 0 0 0 1").transfer, Transfer::display);
}

TEST_F(AffLooks, FmHasGlossAndTransmittance) {
  const Scene scene = read("fm .1 .2 .3 .4 .5 .6 .7 .8 .9 25 .85 1.55\np 3 0 0 0 1 0 0 0 1 0\n");
  const Material& material = material_of(scene);
  EXPECT_EQ(material.model, SurfaceModel::phong);
  EXPECT_EQ(material.specular, glm::vec3(0.7f, 0.8f, 0.9f));
  EXPECT_EQ(material.phong_exponent, 25.0f);
  EXPECT_EQ(material.transmission, 0.85f);
  EXPECT_FALSE(material.tinted_transmission);
  EXPECT_TRUE(material.see_through());
}

TEST_F(AffLooks, FHasThemInNumbersOfItsOwn) {
  const Material material = material_of(read("f .2 .4 .6 .5 .3 12 .25 1.5\np 3 0 0 0 1 0 0 0 1 0\n"));
  EXPECT_EQ(material.specular, glm::vec3(0.3f));
  EXPECT_EQ(material.phong_exponent, 12.0f);
  EXPECT_EQ(material.transmission, 0.25f);
}

TEST_F(AffLooks, NonsenseIsCutToWhatCanBe) {
  const Material material = material_of(read("fm 0 0 0 1 1 1 -1 2 0 -5 7 1\np 3 0 0 0 1 0 0 0 1 0\n"));
  EXPECT_EQ(material.specular, glm::vec3(0, 2, 0));
  EXPECT_EQ(material.phong_exponent, 0.0f);
  EXPECT_EQ(material.transmission, 1.0f);
}

TEST_F(AffLooks, APictureIsFoundBesideTheSceneAndInItsFolders) {
  for (const char* place : {"scene/t.ppm", "scene/textures/t.ppm", "scene/TextureFiles/t.ppm"}) {
    SCOPED_TRACE(place);
    put(place, ppm_of(2, 1, 10, 20, 30));
    const Scene scene = read(textured("t.ppm"));
    fs::remove(folder_ / place);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].name, "t.ppm");
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].rgba[1], 20);
    EXPECT_EQ(material_of(scene).base_color_map.image, 0);
    EXPECT_EQ(material_of(scene).base_color_map.wrap_u, Wrap::repeat);
    EXPECT_EQ(scene.meshes[0].texture_coordinates[0], (std::vector<glm::vec2>{{0, 1}, {1, 1}, {0, 0}}));
  }
}

TEST_F(AffLooks, APictureIsFoundInATexturePath) {
  put("elsewhere/t.ppm", ppm_of(1, 1, 1, 2, 3));
  const Scene scene =
      read(textured("t.ppm"), {.texture_paths = {folder_ / "nowhere", folder_ / "elsewhere"}});
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(read(textured("t.ppm")).images.size(), 0u);
}

void expect_named(const Scene& scene, const std::string& name) {
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find(name), std::string::npos) << scene.warnings[0];
  EXPECT_NE(scene.warnings[0].find("factor"), std::string::npos) << scene.warnings[0];
  EXPECT_EQ(scene.warnings[0].back(), '.');
  EXPECT_TRUE(scene.images.empty());
}

TEST_F(AffLooks, AMissingOrBrokenPictureIsOneWarningWithItsName) {
  put("scene/broken.ppm", "P6 10 10 255 too short");
  for (const std::string name : {"missing.ppm", "broken.ppm"}) {
    const Scene scene = read("f .1 .2 .3 1 0 0 0 1\n" + textured(name) + textured(name));
    expect_named(scene, name);
    EXPECT_EQ(material_of(scene).base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_FALSE(material_of(scene).base_color_map);
    EXPECT_EQ(scene.materials.size(), 1u);
  }
}

TEST_F(AffLooks, NoPictureIsReadFromOutsideTheFolders) {
  put("secret.ppm", ppm_of(1, 1, 1, 2, 3));
  fs::create_symlink(folder_ / "secret.ppm", folder_ / "scene/link.ppm");
  expect_named(read(textured("../secret.ppm")), "../secret.ppm");
  expect_named(read(textured((folder_ / "secret.ppm").string())), "secret.ppm");
  expect_named(read(textured("link.ppm")), "link.ppm");
}

TEST_F(AffLooks, EachPairOfMaterialAndPictureIsOneMaterial) {
  put("scene/a.ppm", ppm_of(1, 1, 1, 2, 3));
  put("scene/b.ppm", ppm_of(1, 1, 4, 5, 6));
  const std::string red = "fm 0 0 0 1 0 0 0 0 0 1 0 1\n", blue = "fm 0 0 0 0 0 1 0 0 0 1 0 1\n";
  const std::string plain = "p 3 0 0 0 1 0 0 0 1 0\n";
  const Scene scene = read(red + textured("a.ppm") + textured("b.ppm") + textured("a.ppm") + plain + blue +
                           textured("a.ppm"));
  EXPECT_EQ(scene.images.size(), 2u);
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.meshes[0].materials[0], scene.meshes[0].materials[2]);
  EXPECT_NE(scene.meshes[0].materials[0], scene.meshes[0].materials[1]);
  EXPECT_FALSE(material_of(scene, 1).base_color_map);
  EXPECT_EQ(material_of(scene, 2).base_color, glm::vec3(0, 0, 1));
  EXPECT_EQ(material_of(scene, 2).base_color_map.image, 0);
  EXPECT_EQ(material_of(scene, 0).name, material_of(scene, 1).name);  // --no-cast names both
}

TEST_F(AffLooks, MeshesHaveACoordinateForEachCorner) {
  put("scene/t.ppm", ppm_of(1, 1, 1, 2, 3));
  for (const std::string normals : {"", "normals 1 0 0 1 "}) {
    const std::string n = normals.empty() ? "" : " 0 0 0";
    const Scene scene = read("m vertices 4 0 0 0 1 0 0 1 1 0 0 1 0 " + normals +
                             "texturecoords 5 t.ppm 0 1 1 1 1 0 0 0 7 8 triangles 2 0 1 2" + n +
                             " 0 1 2  0 2 3" + n + " 4 2 3\n");
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.texture_coordinates[0].size(), mesh.positions.size());
    EXPECT_EQ(mesh.positions.size(), 5u);  // vertex 0 has two coordinates
    const auto at = [&](std::size_t t, int c) { return mesh.texture_coordinates[0][mesh.triangles[t][c]]; };
    EXPECT_EQ(at(0, 0), glm::vec2(0, 1));
    EXPECT_EQ(at(0, 1), glm::vec2(1, 1));
    EXPECT_EQ(at(1, 0), glm::vec2(7, 8));
    EXPECT_EQ(at(1, 2), glm::vec2(0, 0));
    EXPECT_EQ(mesh.positions[mesh.triangles[1].x], glm::vec3(0));
    EXPECT_EQ(mesh.normals.empty(), normals.empty());
  }
}

struct Counted {
  const char* file;
  std::size_t images, textured, transmitting;
};

void PrintTo(const Counted& counted, std::ostream* out) {
  *out << counted.file;
}

class BartLooks : public ::testing::TestWithParam<Counted> {};

/// The figures are those of another reader of the files.
TEST_P(BartLooks, HaveTheTrianglesThatTheFilesSay) {
  // BART's geometry comes with the tests; its textures are too large for that and lie beside the checkout.
  if (!testing::bart_has_textures()) GTEST_SKIP() << "BART's textures are not beside the checkout.";
  const fs::path file = testing::bart_folder() / GetParam().file;
  const auto scene = formats::import_aff(file, {});
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_EQ(scene->images.size(), GetParam().images);
  std::size_t textured = 0, transmitting = 0;
  for (const Mesh& mesh : scene->meshes)
    for (const std::uint32_t index : mesh.materials) {
      textured += scene->materials[index].base_color_map.image >= 0;
      transmitting += scene->materials[index].transmission > 0;
    }
  EXPECT_EQ(textured, GetParam().textured);
  EXPECT_EQ(transmitting, GetParam().transmitting);
  for (const std::string& warning : scene->warnings)
    EXPECT_EQ(warning.find("texture"), warning.npos) << warning;
}

INSTANTIATE_TEST_SUITE_P(Bart, BartLooks,
                         ::testing::Values(Counted{"robots/Robot.aff", 44, 65786, 1516},
                                           Counted{"kitchen/kitchen.aff", 8, 5328, 19128},
                                           Counted{"museum/museum5.aff", 5, 10, 0}));

}  // namespace
}  // namespace tenebra
