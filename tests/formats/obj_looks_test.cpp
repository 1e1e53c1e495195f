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
  const Scene beyond = read("newmtl m\nmap_Kd -s 1e300 2 1 t.png\n", textured_square);
  EXPECT_EQ(beyond.materials.at(0).base_color_map.transform[0].x, 1);
}

TEST_F(ObjLooks, NamesOfOtherMachinesAreFoundByTheirLastPart) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  EXPECT_EQ(read("newmtl m\nmap_Kd C:\\maps\\t.png\n", textured_square).images.size(), 1u);
  EXPECT_EQ(read("newmtl m\nmap_Kd ../../maps/t.png\n", textured_square).images.size(), 1u);
}

TEST_F(ObjLooks, WhatIsMissingOrNotUsedIsNamed) {
  const Scene scene = read("newmtl m\nKd 1 0 0\nmap_Kd none.png\nmap_Ps b.png\n", textured_square);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("none.png"), std::string::npos) << scene.warnings[0];
  EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1, 0, 0));
  ASSERT_EQ(scene.unused.size(), 1u);
  EXPECT_EQ(scene.unused[0].name, "map_Ps");
}

TEST_F(ObjLooks, OfManyKindsThatAreNotUsedTheNamedOnesAreCounted) {
  std::string maps;
  for (char c = 'a'; c <= 'z'; ++c) maps += std::string("map_x") + c + " b.png\n";
  const Scene scene = read("newmtl m\n" + maps + "map_xa b.png\n", textured_square);
  ASSERT_EQ(scene.unused.size(), 20u);
  EXPECT_EQ(scene.unused[0].name, "map_xa");
  EXPECT_EQ(scene.unused[0].count, 2u);
}

TEST_F(ObjLooks, AlphaOfAPictureStaysWhereTr1MeansOpaque) {
  write_text(folder_ / "shares.png", png_of({2, 2, 1, {255, 0, 0, 255}}));
  const Scene scene = read("newmtl m\nTr 1\nmap_d shares.png\n", textured_square);
  EXPECT_EQ(scene.materials.at(0).alpha, 1.0f);
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::mask);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(ObjLooks, AlphaThatLiesOtherwiseThanTheColoursIsNamed) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  const std::string maps = "map_Kd t.png\nmap_d -s 2 2 1 t.png\n";
  const Scene scene = read("newmtl m\n" + maps + "newmtl n\n" + maps, textured_square);
  EXPECT_EQ(scene.materials.at(0).alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(scene.warnings,
            std::vector<std::string>{"material 'm' and 1 more: found map_d with other options than map_Kd, "
                                     "expected the same; it is not used."});
}

TEST_F(ObjLooks, MapsOfNormalsAlphaAndGlossAreRead) {
  write_text(folder_ / "t.png", png_of(small_picture(2, 2)));
  io::Image8 heights{2, 2, 1, {0, 255, 0, 255}}, normals{2, 2, 3, {}}, shares{2, 2, 1, {255, 0, 0, 255}};
  for (int i = 0; i < 4; ++i) normals.pixels.insert(normals.pixels.end(), {128, 128, 255});
  write_text(folder_ / "heights.png", png_of(heights));
  write_text(folder_ / "normals.png", png_of(normals));
  write_text(folder_ / "shares.png", png_of(shares));
  const std::string gloss = "newmtl m\nKd 1 1 1\nKs 1 1 1\nNs 20\n";
  const auto material = [&](const std::string& maps) {
    return read(gloss + maps, textured_square).materials.at(0);
  };
  EXPECT_TRUE(material("norm normals.png\n").normal_map);
  EXPECT_TRUE(material("map_Ks t.png\nmap_Ns t.png\n").specular_map);
  EXPECT_TRUE(material("map_Ks t.png\nmap_Ns t.png\n").exponent_map);
  const Scene bumps = read(gloss + "bump -bm 2 heights.png\n", textured_square);
  ASSERT_EQ(bumps.images.size(), 2u) << "the heights, and normals made of them";
  EXPECT_EQ(bumps.materials[0].normal_map.image, 1);
  EXPECT_EQ(read(gloss + "map_Bump normals.png\n", textured_square).materials[0].normal_map.image, 0);
  const Scene cut = read(gloss + "map_Kd t.png\nmap_d shares.png\n", textured_square);
  EXPECT_EQ(cut.materials[0].alpha_mode, AlphaMode::mask);
  EXPECT_EQ(cut.images.at(static_cast<std::size_t>(cut.materials[0].base_color_map.image)).rgba.at(3), 255);
  EXPECT_EQ(cut.images.at(static_cast<std::size_t>(cut.materials[0].base_color_map.image)).rgba.at(7), 0);
}

TEST_F(ObjLooks, PicturesOfRoughnessAndMetalTakeThePlaceOfTheirNumbers) {
  write_text(folder_ / "rough.png", png_of({1, 1, 1, {40}}));
  write_text(folder_ / "metal.png", png_of({1, 1, 1, {200}}));
  const auto looks = [&](const std::string& lines, glm::ivec2 green_blue) {
    const Scene scene = read("newmtl m\n" + lines, textured_square);
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.model, SurfaceModel::metallic_roughness);
    const auto& rgba = scene.images.at(static_cast<std::size_t>(material.metallic_roughness_map.image)).rgba;
    EXPECT_EQ(glm::ivec2(rgba[1], rgba[2]), green_blue) << lines;
    EXPECT_TRUE(scene.unused.empty());
    return glm::vec2(material.roughness, material.metallic);
  };
  EXPECT_EQ(looks("Pr 0.5\nPm 0\nmap_Pr rough.png\nmap_Pm metal.png\n", {40, 200}), glm::vec2(1, 1));
  EXPECT_EQ(looks("map_Pr rough.png\n", {40, 255}), glm::vec2(1, 0));
  EXPECT_EQ(looks("Pr 0.25\nmap_Pm metal.png\n", {255, 200}), glm::vec2(0.25f, 1));
  write_text(folder_ / "packed.png", png_of({1, 1, 3, {9, 40, 200}}));
  looks("map_Pr packed.png\nmap_Pm packed.png\n", {40, 200});
  const Scene apart =
      read("newmtl m\nPm 0.75\nmap_Pr rough.png\nmap_Pm -s 2 2 1 metal.png\n", textured_square);
  EXPECT_EQ(apart.materials.at(0).metallic, 0.75f);
  EXPECT_EQ(apart.warnings,
            std::vector<std::string>{"material 'm': found map_Pm with other options than map_Pr, expected "
                                     "the same; it is not used."});
  const Scene missing = read("newmtl m\nPr 0.5\nmap_Pr none.png\n", textured_square);
  EXPECT_EQ(missing.materials.at(0).roughness, 0.5f);
  EXPECT_FALSE(missing.materials[0].metallic_roughness_map);
}

TEST_F(ObjLooks, ColoursOfVerticesAreRead) {
  const Scene scene = read("newmtl m\nKd 1 1 1\n", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 .5\nf 1 2 3\n");
  EXPECT_EQ(scene.meshes.at(0).colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 0.5f, 1}}));
  EXPECT_TRUE(read("newmtl m\nKd 1 1 1\n", textured_square).meshes.at(0).colors.empty());
}

}  // namespace
}  // namespace tenebra
