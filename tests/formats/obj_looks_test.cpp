// What MTL files say of surfaces.
#include <gtest/gtest.h>

#include <filesystem>

#include "formats/import_scene.h"
#include "pictures.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::png_of;
using testing::small_picture;
using testing::write_text;

class ObjLooks : public ::testing::Test {
protected:
  Scene read(const std::string& mtl, const std::string& obj) const {
    write_text(folder_ / "a.mtl", mtl);
    write_text(folder_ / "a.obj", "mtllib a.mtl\nusemtl m\n" + obj);
    auto scene = formats::import_obj(folder_ / "a.obj");
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  Material material(const std::string& lines) const {
    const Scene scene = read("newmtl m\n" + lines, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    return scene.materials.at(0);
  }

  testing::TemporaryFolder folder_;
};

constexpr const char* textured_square =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/3 3/1 4/4\n";

TEST_F(ObjLooks, ColoursGlossAndEmissionAreRead) {
  const Material material = this->material("Kd .1 .2 .3\nKs .4 .5 .6\nNs 20\nKe 1 2 3\nillum 2\n");
  EXPECT_EQ(material.model, SurfaceModel::phong);
  EXPECT_EQ(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(material.specular, glm::vec3(0.4f, 0.5f, 0.6f));
  EXPECT_EQ(material.phong_exponent, 20.0f);
  EXPECT_EQ(material.emissive, glm::vec3(1, 2, 3));
  EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
}

TEST_F(ObjLooks, DiffuseOnlyHasNoGloss) {
  EXPECT_EQ(material("Ks 1 1 1\nillum 1\n").specular, glm::vec3(0));
}

TEST_F(ObjLooks, DissolveAndTransparencyAreAlpha) {
  EXPECT_EQ(material("d 0.25\n").alpha_mode, AlphaMode::blend);
  EXPECT_EQ(material("d 0.25\n").alpha, 0.25f);
  EXPECT_EQ(material("Tr 0.25\n").alpha, 0.75f);
  EXPECT_EQ(material("d 1\n").alpha_mode, AlphaMode::opaque);
}

TEST_F(ObjLooks, PicturesLieWithTheirBottomAtVZero) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  const Scene scene = read("newmtl m\nmap_Kd t.png\n", textured_square);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.materials[0].base_color_map.image, 0);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 6u);  // corners 1 and 3 have two coordinates each
  const auto at = [&](std::size_t t, int c) { return mesh.texture_coordinates[0][mesh.triangles[t][c]]; };
  EXPECT_EQ(at(0, 0), glm::vec2(0, 1));
  EXPECT_EQ(at(0, 2), glm::vec2(1, 0));
  EXPECT_EQ(at(1, 0), glm::vec2(1, 0));
}

TEST_F(ObjLooks, CoordinatesPartNoVerticesWithoutAPicture) {
  const Scene scene = read("newmtl m\nKd 1 1 1\n", textured_square);
  EXPECT_EQ(scene.meshes.at(0).positions.size(), 4u);
  EXPECT_TRUE(scene.meshes[0].texture_coordinates[0].empty());
}

TEST_F(ObjLooks, OptionsOfAPictureMoveIt) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  const Scene scene = read("newmtl m\nmap_Kd -clamp on -o 0.5 0.25 0 -s 2 3 1 t.png\n", textured_square);
  const TextureMap& map = scene.materials.at(0).base_color_map;
  EXPECT_EQ(map.wrap_u, Wrap::clamp_to_edge);
  // In OBJ's sense (u, v) = (1, 1) becomes (2.5, 3.25); ours has 1 - v.
  const glm::vec2 moved = map.transform * glm::vec3(1, 0, 1);
  EXPECT_FLOAT_EQ(moved.x, 2.5f);
  EXPECT_FLOAT_EQ(moved.y, 1 - 3.25f);
}

TEST_F(ObjLooks, NamesOfOtherMachinesAreFoundByTheirLastPart) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  EXPECT_EQ(read("newmtl m\nmap_Kd C:\\maps\\t.png\n", textured_square).images.size(), 1u);
  EXPECT_EQ(read("newmtl m\nmap_Kd ../../maps/t.png\n", textured_square).images.size(), 1u);
}

TEST_F(ObjLooks, WhatIsMissingOrNotUsedIsNamed) {
  const Scene scene = read("newmtl m\nKd 1 0 0\nmap_Kd none.png\nmap_bump b.png\n", textured_square);
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_NE(scene.warnings[0].find("none.png"), std::string::npos) << scene.warnings[0];
  EXPECT_NE(scene.warnings[1].find("map_bump: found in 1 material,"), std::string::npos) << scene.warnings[1];
  EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1, 0, 0));
  ASSERT_EQ(scene.unused.size(), 1u);
  EXPECT_EQ(scene.unused[0].name, "map_bump");
}

TEST_F(ObjLooks, ColoursOfVerticesAreRead) {
  const Scene scene = read("newmtl m\nKd 1 1 1\n", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 .5\nf 1 2 3\n");
  EXPECT_EQ(scene.meshes.at(0).colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 0.5f, 1}}));
  EXPECT_TRUE(read("newmtl m\nKd 1 1 1\n", textured_square).meshes.at(0).colors.empty());
}

}  // namespace
}  // namespace tenebra
