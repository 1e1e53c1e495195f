// OBJ and MTL files as exporters write them: what leaves the surface certain is read.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>

#include "formats/import_scene.h"
#include "formats/obj/obj_file.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::write_text;

constexpr const char* square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjText : public ::testing::Test {
protected:
  Expected<Scene> import(const std::string& obj) const {
    write_text(folder_ / "a.obj", obj);
    return formats::import_obj(folder_ / "a.obj");
  }
  Scene read(const std::string& obj) const {
    auto scene = import(obj);
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  /// The sentence of a file that must not be read, without the folder.
  std::string refusal(const std::string& obj) const {
    const auto scene = import(obj);
    EXPECT_FALSE(scene.has_value());
    return scene ? "" : scene.error().message.substr((folder_ / "").string().size());
  }
  static std::size_t triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
  }
  /// The material of the first triangle.
  static const Material& first(const Scene& scene) {
    return scene.materials.at(scene.meshes.at(0).materials.at(0));
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ObjText, CommentsBeginAnywhere) {
  const Scene scene =
      read("v 0 0 0 # a\nv 1 0 0# b\nv 1 1 0\n#\nv 0 1 0\nf 1 2 3 4 # bottom\nf 4 3 2 1# top\n");
  EXPECT_EQ(triangles(scene), 4u);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
}

TEST_F(ObjText, LinesEndInEveryWayAndAreContinued) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = std::string(square) + "f 1 2 \\\n 3 \\\n 4\n# C:\\folder\\\nf 1 2 3";
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
      text.replace(at, 1, end);
    EXPECT_EQ(triangles(read(text)), 3u);
  }
}

TEST_F(ObjText, AMillionEmptyLinesTakeNoTime) {
  const std::clock_t before = std::clock();
  EXPECT_EQ(formats::parse_obj(std::string(1'000'000, '\r') + square).positions.size(), 4u);
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 2);
}

TEST_F(ObjText, NumbersAreReadInDoubleAndInEverySpelling) {
  const auto file = formats::parse_obj("v 5334567.381 +1 1e-400\nv -1.#IND 1.#INF nan\nv 1. .5 -2E+2 # w\n");
  EXPECT_EQ(file.positions[0], glm::dvec3(5334567.381, 1, 0));
  EXPECT_TRUE(std::isnan(file.positions[1].x) && !std::isfinite(file.positions[1].y) &&
              std::isnan(file.positions[1].z));
  EXPECT_EQ(file.positions[2], glm::dvec3(1, 0.5, -200));
  const std::string zeros(400, '0');
  const auto extreme = formats::parse_obj("v 0." + zeros + "1 -1" + zeros + " 1e400\nv -1E-400 0 0\n");
  EXPECT_EQ(extreme.positions[0], glm::dvec3(0, -INFINITY, INFINITY));
  EXPECT_EQ(extreme.positions[1], glm::dvec3(0));
}

TEST_F(ObjText, MapCoordinatesLoseAWholeOffsetBeforeTheyBecomeFloats) {
  const Scene scene =
      read("v 431234.75 0 -5812345.25\nv 431245.05 0 -5812345.25\nv 431245.05 6 -5812353.45\nf 1 2 3\n");
  EXPECT_EQ(glm::round(scene.frame.origin), scene.frame.origin);
  EXPECT_NE(scene.frame.origin, glm::dvec3(0));
  const glm::dvec3 edge =
      glm::dvec3(scene.meshes.at(0).positions[1]) - glm::dvec3(scene.meshes[0].positions[0]);
  EXPECT_NEAR(edge.x, 10.3, 1e-5) << "floats of the file's own numbers give 10.3125";
}

TEST_F(ObjText, AByteOrderMarkIsNoPartOfTheFirstWord) {
  write_text(folder_ / "a.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  const Scene scene = read("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(first(scene).base_color, glm::vec3(1, 0, 0));
}

TEST_F(ObjText, PolygonsHaveAnyNumberOfCorners) {
  std::string text, face = "f";
  for (int i = 0; i < 300; ++i) {
    const double angle = 2 * M_PI * i / 300;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  const Scene scene = read(text + face + "\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf -3 -2 -1\n");
  double area = 0;
  for (const glm::uvec3& t : scene.meshes.at(0).triangles) {
    const auto& p = scene.meshes[0].positions;
    area += glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z / 2;
  }
  EXPECT_EQ(triangles(scene), 299u);
  EXPECT_NEAR(area, 150 * std::sin(2 * M_PI / 300) + 0.5, 1e-4);
}

TEST_F(ObjText, MissingNormalsAndCoordinatesAreAWarning) {
  for (const std::string face : {"f 1//1 2//2 3//3\n", "f 1/1/7 2/2/7 3/3/7\n", "f 1/-9 2/ 3//\n"}) {
    const Scene scene = read(square + face);
    EXPECT_EQ(triangles(scene), 1u);
    EXPECT_FALSE(scene.warnings.empty());
    EXPECT_TRUE(scene.meshes.at(0).normals.empty());
  }
}

TEST_F(ObjText, ColoursOfSomeVerticesLeaveTheOthersWhite) {
  const Scene scene =
      read("o a\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\no b\nv 5 0 0\nf 1 3 2\nf 2 3 4\n");
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {1, 1, 1, 1}, {0, 1, 0, 1}}));
  EXPECT_TRUE(read("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").meshes.at(0).colors.empty());  // weights
  for (const std::string number : {" nan nan nan", " 1 1 inf", " 1e300 0 0"})
    EXPECT_TRUE(formats::parse_obj("v 0 0 0" + number + "\n").colors.empty()) << number;
}

TEST_F(ObjText, NamesMayHoldBlanksAndNumberSigns) {
  write_text(folder_ / "my model #2.mtl",
             "newmtl red # the first\nKd 1 0 0\n\tnewmtl Material #1\n\tKd 0 1 0\n");
  const std::string head = std::string(square) + "mtllib my model #2.mtl\n";
  EXPECT_EQ(first(read(head + "usemtl red\nf 1 2 3\n")).base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(first(read(head + "usemtl red # again\nf 1 2 3\n")).base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(first(read(head + "usemtl Material #1\nf 1 2 3\n")).base_color, glm::vec3(0, 1, 0));
}

TEST_F(ObjText, LibrariesAreFoundAsExportersNameThem) {
  write_text(folder_ / "a.mtl", "newmtl red\nKd 1 0 0\n");
  for (const std::string name :
       {"a.mtl", "C:\\work\\a.mtl", "b.mtl a.mtl", "\"a.mtl\"", "./a.mtl # c", "gone.mtl"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(first(read(square + ("mtllib " + name) + "\nusemtl red\nf 1 2 3\n")).base_color,
              glm::vec3(1, 0, 0));
  }
}

TEST_F(ObjText, ALibraryThatIsNotThereChangesNoOtherRemark) {
  const std::string faces = "usemtl red\nf 1 2 3\n";
  write_text(folder_ / "a.mtl", "newmtl red\nKd 1 0 0\n");
  EXPECT_EQ(read(square + ("vp 1\nmtllib # none\n" + faces)).warnings.at(0),
            "Line 5: found 'vp', which is not read.");
  const Scene named = read(square + ("mtllib gone.mtl lost.mtl\n" + faces));
  EXPECT_EQ(named.warnings, std::vector<std::string>{"mtllib 'gone.mtl lost.mtl': found no such file beside "
                                                     "the scene; a.mtl is read in its place."});
}

TEST_F(ObjText, TheLibraryOfTheSceneSNameLeadsOutOfItsFolderNeither) {
  const testing::TemporaryFolder other;
  write_text(other / "a.mtl", "newmtl red\nKd 1 0 0\n");
  std::filesystem::create_symlink(other / "a.mtl", folder_ / "a.mtl");
  const Scene scene = read(square + std::string("mtllib gone.mtl\nusemtl red\nf 1 2 3\n"));
  EXPECT_EQ(first(scene).base_color, Material().base_color);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("its materials are grey"), std::string::npos) << scene.warnings[0];
}

TEST_F(ObjText, MaterialsAreLimited) {
  std::string text = "newmtl red\nKd 1 0 0\n";
  for (int i = 0; i < 100'000; ++i) text += "newmtl\n";
  write_text(folder_ / "a.mtl", text + "Kd 0 1 0\n");
  write_text(folder_ / "b.mtl", "newmtl b\n");
  const Scene scene = read(square + std::string("mtllib a.mtl b.mtl\nusemtl red\nf 1 2 3\n"));
  EXPECT_EQ(scene.materials.size(), 100'000u);
  EXPECT_EQ(first(scene).base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.materials.back().base_color, scene.materials[1].base_color) << "no more than its own lines";
  EXPECT_EQ(scene.warnings,
            std::vector<std::string>{"mtllib: found more than 100000 materials: the others are grey."});
}

TEST_F(ObjText, ManyUnknownWordsHideNoOtherRemark) {
  std::string words;
  for (char c = 'a'; c <= 'z'; ++c) words += std::string("x") + c + "\n";
  const auto file = formats::parse_obj(square + words + "xa\nf 1 2\n");
  ASSERT_EQ(file.warnings.size(), 22u);
  EXPECT_EQ(file.warnings[0], "Line 5 and 1 more: found 'xa', which is not read.");
  EXPECT_EQ(file.warnings[20], "Line 25 and 5 more: found other words that are not read.");
  EXPECT_EQ(file.warnings[21], "Line 32: found a face of fewer than three corners, which is left out.");
}

TEST_F(ObjText, WhatIsNotReadIsSaidOnceForEachKind) {
  const Scene scene = read(
      square + std::string("g\ns 1\nvp 1 2\nvp 3 4\nl 1 2\np 1\nf 1 2\nf 1 2 3\nusemtl none\nf 1 2 3\n"));
  ASSERT_EQ(scene.warnings.size(), 3u);
  EXPECT_EQ(scene.warnings[0], "Line 7 and 1 more: found 'vp', which is not read.");
  EXPECT_EQ(scene.warnings[1], "Line 11: found a face of fewer than three corners, which is left out.");
  EXPECT_EQ(scene.warnings[2], "Skipped 2 lines of points and lines.");
  EXPECT_EQ(read(square + std::string("p 1\nf 1 2 3\n")).warnings[0], "Skipped 1 line of points and lines.");
}

TEST_F(ObjText, WhatLeavesTheSurfaceInDoubtIsRefusedWithItsLine) {
  const std::string s = square;
  EXPECT_EQ(
      refusal("v 0 0 0\nv 0,25 1,5 0\n"),
      "a.obj: line 2: found '0,25', expected a decimal point: export it again, with a language whose numbers "
      "have one.");
  EXPECT_EQ(refusal("v 1 2\n"), "a.obj: line 1: found 2 numbers, expected x, y and z.");
  EXPECT_EQ(refusal("v 1 2 3x\n"), "a.obj: line 1: found '3x', expected a number.");
  for (const std::string corner : {"0", "-5", "x", "1/2/3/4", "99999999999", "1.5"})
    EXPECT_NE(refusal(s + "f 1 2 " + corner + "\n").find("line 5: found '" + corner + "' in a face"),
              std::string::npos);
  EXPECT_NE(refusal(s + "f 1 2 9\n").find("line 5: found vertex 9 in a face, expected 1 to 4"),
            std::string::npos);
}

TEST_F(ObjText, MaterialsTolerateCommasAndOddNumbers) {
  write_text(folder_ / "a.mtl",
             "Kd 1 1 1\nnewmtl red\nKD 0,8 0,5 0,25\nNs 10,0\nd -halo 0.5\nKs x\nillum 2.0\n");
  const Scene scene = read(std::string(square) + "mtllib a.mtl\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(first(scene).base_color, glm::vec3(0.8f, 0.5f, 0.25f));
  EXPECT_EQ(first(scene).phong_exponent, 10.0f);
  EXPECT_EQ(first(scene).alpha, 0.5f);
  ASSERT_EQ(scene.warnings.size(), 4u);
  EXPECT_NE(scene.warnings[1].find("a.mtl, line 3"), std::string::npos) << scene.warnings[1];
}

TEST_F(ObjText, NumbersOfMaterialsBeyondFloatsAreNone) {
  write_text(folder_ / "a.mtl", "newmtl a\nKd 1e300 0 0\nKs .5 1e300 .5\nNs 1e300\n");
  const Scene scene = read(std::string(square) + "mtllib a.mtl\nusemtl a\nf 1 2 3\n");
  EXPECT_EQ(first(scene).base_color, glm::vec3(0.6f));
  EXPECT_EQ(first(scene).specular, glm::vec3(0.5f));
  EXPECT_EQ(first(scene).phong_exponent, 1.0f);
}

TEST_F(ObjText, Tr1InAllMaterialsIsOpaqueAndNs0IsMatte) {
  write_text(folder_ / "a.mtl", "newmtl a\nTr 1.0\nKs 1 1 1\nNs 0\n");
  const std::string text = std::string(square) + "mtllib a.mtl\nusemtl a\nf 1 2 3\n";
  const Scene opaque = read(text);
  EXPECT_EQ(first(opaque).alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(first(opaque).specular, glm::vec3(0));
  EXPECT_EQ(opaque.warnings.size(), 1u);
  write_text(folder_ / "a.mtl", "newmtl a\nTr 1.0\nnewmtl b\nTr 0\n");
  EXPECT_EQ(first(read(text)).alpha, 0.0f);
}

TEST_F(ObjText, MetalAndRoughnessOfTheNewerStatementsAreRead) {
  write_text(folder_ / "a.mtl", "newmtl a\nPr 0.25\nPm 1\n");
  const Scene scene = read(std::string(square) + "mtllib a.mtl\nusemtl a\nf 1 2 3\n");
  EXPECT_EQ(first(scene).model, SurfaceModel::metallic_roughness);
  EXPECT_EQ(first(scene).roughness, 0.25f);
  EXPECT_EQ(first(scene).metallic, 1.0f);
}

}  // namespace
}  // namespace tenebra
