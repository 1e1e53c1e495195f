// PLY files as programs write them, and broken ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>

#include "formats/text_scene.h"

namespace tenebra {
namespace {

using testing::write_text;

/// `value` as bytes of a file, the lowest first unless `big`.
template <class T>
std::string ply_bytes(T value, bool big) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string ply_text(const std::string& properties, const std::string& values) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
         properties + "end_header\n" + values;
}
constexpr const char* ply_faces = "element face 1\nproperty list uchar int vertex_indices\n";

class Ply : public testing::TextScene {
protected:
  Ply() : TextScene("a.ply") {}
};

TEST_F(Ply, TextWithAPolygonIsCutAndMoreThanIsStatedInALineIsPassedOver) {
  const Scene scene = read(ply_text(ply_faces, "0 0 0 9\n1 0 0\n1 1 0\n0 1 0 9 9\n4 0 1 2 3 9\n"));
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions.at(2), glm::vec3(1, 1, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Ply, BinaryOfBothByteOrdersKeepsDoublesOfTheMap) {
  for (const bool big : {false, true}) {
    std::string text = "ply\r\nformat binary_" + std::string(big ? "big" : "little") +
                       "_endian 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty double y\r\n"
                       "property double z\r\nelement face 1\r\nproperty uchar flags\r\n"
                       "property list ushort uint vertex_index\r\nend_header\r\n";
    for (const glm::dvec3 p : {glm::dvec3(431234.75, 5812345.25, 10), glm::dvec3(431245.05, 5812345.25, 10),
                               glm::dvec3(431245.05, 5812353.45, 16)})
      for (int axis = 0; axis < 3; ++axis) text += ply_bytes(p[axis], big);
    text += '\n' + ply_bytes(std::uint16_t{3}, big);
    for (const std::uint32_t corner : {0u, 1u, 2u}) text += ply_bytes(corner, big);
    formats::ImportOptions options;
    options.keep_unrounded = true;
    const auto scene = import(text, options);
    ASSERT_TRUE(scene.has_value()) << scene.error().message;
    const Mesh& mesh = scene->meshes.at(0);
    EXPECT_NE(scene->frame.origin, glm::dvec3(0));
    EXPECT_TRUE(scene->warnings.empty());
    EXPECT_NEAR(mesh.positions.at(1).x - mesh.positions[0].x, 10.3, 1e-5);
    EXPECT_EQ(mesh.unrounded.at(1) + scene->frame.origin, glm::dvec3(431245.05, 5812345.25, 10));
    EXPECT_EQ(mesh.triangles.at(0), glm::uvec3(0, 1, 2));
    EXPECT_EQ(scene->unused.at(0).name, "face flags");
  }
}

TEST_F(Ply, BytesOfColoursAreEncodedAndAlphaThatIsZeroEverywhereIsNone) {
  const std::string colors =
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  const Scene scene = read(ply_text(colors + ply_faces,
                                    "0 0 0 255 0 188 0\n1 0 0 0 0 0 0\n1 1 0 0 0 0 0\n0 1 0 0 0 0 0\n"
                                    "3 0 1 2\n"));
  const glm::vec4 color = scene.meshes.at(0).colors.at(0);
  EXPECT_EQ(glm::vec2(color.x, color.y), glm::vec2(1, 0));
  EXPECT_NEAR(color.z, 0.5029f, 1e-4) << "188 of 255, by the curve of sRGB";
  EXPECT_EQ(color.w, 1);
  EXPECT_EQ(scene.materials.at(0).base_color, glm::vec3(1));
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::opaque);
}

TEST_F(Ply, CornersWithCoordinatesOfTheirOwnGetVertices) {
  write_text(folder_ / "a.ppm", "P3 1 1 255 9 9 9\n");
  const std::string lists = "property list uchar int vertex_indices\nproperty list uchar float texcoord\n",
                    one = "element face 1\n" + lists,
                    values = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0 1 1 0 1\n";
  const auto textured = [](const std::string& elements, const std::string& rows) {
    return "ply\nformat ascii 1.0\ncomment TextureFile a.ppm\n" + ply_text(elements, rows).substr(21);
  };
  for (const std::string& elements : {"element face 2\n" + lists, one + one}) {
    const Scene scene = read(textured(elements, values));
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.positions.size(), 5u) << "vertex 0 has two";
    EXPECT_EQ(mesh.triangles.at(1), glm::uvec3(4, 2, 3));
    EXPECT_EQ(mesh.texture_coordinates[0].at(1), glm::vec2(1, 1));
    EXPECT_EQ(mesh.texture_coordinates[0].at(4), glm::vec2(0.5, 1)) << "v points up in the file";
    EXPECT_EQ(scene.materials.at(0).base_color_map.image, 0);
  }
  const std::string added = refusal(textured(one + one + one, values + "3 0 1 4 0\n"));
  EXPECT_NE(added.find("from 0 to 3"), std::string::npos) << added;
}

TEST_F(Ply, PolygonsThatWouldTakeMinutesAreRefusedFast) {
  constexpr int count = 200'000;
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                     "\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list int int vertex_indices\nend_header\n";
  std::string face = std::to_string(count);
  for (int i = 0; i < count; ++i) {
    text += std::to_string(i) + " 0 0\n";  // in a line: no corner is an ear
    face += " " + std::to_string(i);
  }
  const auto start = std::chrono::steady_clock::now();
  const std::string message = refusal(text + face + "\n");
  EXPECT_NE(message.find("found a polygon of 200000 corners"), std::string::npos) << message;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(Ply, APolygonOfMoreThanAMillionCornersIsRefused) {
  std::string face = "1048577";
  for (int i = 0; i < 1'048'577; ++i) face += " 0";
  const std::string message = refusal(ply_text("element face 1\nproperty list int int vertex_indices\n",
                                               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + face + "\n"));
  EXPECT_NE(message.find("found a polygon of 1048577 corners"), std::string::npos) << message;
}

TEST_F(Ply, StripsTurnEverySecondTriangle) {
  const Scene scene = read(ply_text("element tristrips 1\nproperty list int int vertex_indices\n",
                                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n"));
  const std::vector<glm::uvec3> expected{{0, 1, 2}, {2, 1, 3}, {0, 1, 2}};
  EXPECT_EQ(scene.meshes.at(0).triangles, expected);
}

TEST_F(Ply, WhatIsNoMeshIsASentence) {
  const auto says = [&](const std::string& text, const char* part) {
    EXPECT_NE(refusal(text).find(part), std::string::npos) << refusal(text);
  };
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  says("plyx\n", "line 1: found no 'ply'");
  says("ply\nformat ascii 1.0\n", "found no end_header");
  says("ply\nformat text 1.0\nend_header\n", "line 2: found format 'text'");
  says("ply\nformat ascii 1.0\nelement vertex many\n", "found 'many' as a count of 'vertex'");
  says("ply\nformat ascii 1.0\nelement vertex 18446744073709551617\n", "as a count of 'vertex'");
  says("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", "line 4: found type 'half'");
  says(ply_text("", square), "found 4 points and no faces");
  says(ply_text(ply_faces, square + "4 0 1 2 4\n"),
       "face 0: found vertex 4, expected a whole number from 0 to 3");
  says(ply_text(ply_faces, square + "4 0 1 1.5 3\n"), "face 0: found vertex 1.5, expected a whole number");
  says(ply_text(ply_faces, square + "4 0 1 x 3\n"), "line 14: found 'x', expected a number");
  says(ply_text(ply_faces, square + "3 0 1  "), "end of the file, expected more: copy it again");
  says(ply_text("element face 99999999\nproperty list uchar int vertex_indices\n", square + "3 0 1 2\n"),
       "element 'face': found a count of 99999999");
  says(ply_text("element face 1\nproperty list uchar int vertex_indices\n", square + "999 0 1 2\n"),
       "list 'vertex_indices': found a length of 999");
  says("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "with x, y and z");
}

}  // namespace
}  // namespace tenebra
