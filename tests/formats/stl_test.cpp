// STL files, text and binary, and broken ones.
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cstdint>

#include "formats/text_scene.h"

namespace tenebra {
namespace {

std::string facet(const std::string& vertices) {
  return "facet normal 0 0 1\nouter loop\n" + vertices + "endloop\nendfacet\n";
}
const std::string stl_triangle = facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n");

/// The binary form, stating `stated` triangles and holding `held`, that of stl_triangle each time.
std::string binary_stl(std::uint32_t stated, int held, std::string begin = "solid by a CAD program",
                       float east = 0) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i);
    return bytes;
  };
  begin.resize(80, ' ');
  std::string file = begin + word(stated);
  for (int i = 0; i < held; ++i) {
    for (const float x : {0.f, 0.f, 1.f, east, 0.f, 0.f, east + 1, 0.f, 0.f, east + 1, 1.f, 0.f})
      file += word(std::bit_cast<std::uint32_t>(x));
    file += std::string(2, '\0');
  }
  return file;
}

class Stl : public testing::TextScene {
protected:
  Stl() : TextScene("a.STL") {}
  void refuses(const std::string& text, const char* part) const {
    const std::string sentence = refusal(text);
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
  }
};

TEST_F(Stl, SolidsAreMeshesWithTheirNamesAndSharedVertices) {
  const Scene scene =
      read("solid part #3\n" + stl_triangle + facet("vertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n") +
           "endsolid\nSOLID C:\\b\n" + stl_triangle + "endsolid\n");
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.nodes.at(0).name, "part #3");
  EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
  EXPECT_EQ(scene.meshes[1].triangles.at(0), glm::uvec3(0, 1, 2));
  EXPECT_EQ(scene.frame.up, UpAxis::z);
  EXPECT_EQ(scene.meshes[0].positions[2], glm::vec3(1, 0, -1)) << "Z of the file is up";
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Stl, TextKeepsTheDigitsOfTheMap) {
  const Scene scene = read("solid\n" +
                           facet("vertex 431234.75 5812345.25 0\nvertex 431245.05 5812345.25 0\n"
                                 "vertex 431245.05 5812353.45 6\n") +
                           "endsolid\n");
  const auto& positions = scene.meshes.at(0).positions;
  EXPECT_NE(scene.frame.origin, glm::dvec3(0));
  EXPECT_NEAR(positions.at(1).x - positions[0].x, 10.3, 1e-5);
}

TEST_F(Stl, AFacetOfMoreCornersIsCut) {
  const Scene scene =
      read("solid\n" + facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n") + "endsolid\n");
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2u);
}

TEST_F(Stl, VerticesInALineAlongZAreFoundFast) {
  std::string text = "solid\n";
  constexpr int count = 3 << 14;
  for (int z = 0; z < count; z += 3) {
    std::string corners;
    for (int k = 0; k < 3; ++k) corners += "vertex 0 0 " + std::to_string(z + k) + "\n";
    text += facet(corners);
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(read(text + "endsolid\n").meshes.at(0).positions.size(), std::size_t{count});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2)) << "their slots collide";
}

TEST_F(Stl, TextMayBeginWithAByteOrderMark) {
  const Scene scene = read("\xEF\xBB\xBFsolid a\n" + stl_triangle + "endsolid\n");
  EXPECT_EQ(scene.nodes.at(0).name, "a");
}

TEST_F(Stl, BinaryIsToldByItsSizeThoughItBeginsWithSolid) {
  const Scene scene = read(binary_stl(2, 2));
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(read(binary_stl(0, 2)).meshes.at(0).triangles.size(), 2u) << "a count that was never written";
  EXPECT_EQ(read(binary_stl(1, 2, "x")).warnings.size(), 1u);
}

TEST_F(Stl, WhatIsCutOffOrSomethingElseIsASentence) {
  refuses(binary_stl(3, 2, "x"), "found 3 triangles stated and the bytes of 2");
  refuses("facets", "found 6 bytes and no 'solid'");
  refuses("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "end of the file within a facet");
  refuses("solid\n" + facet("vertex 0 0 0\nvertex 1,5 0 0\nvertex 1 1 0\n"), "line 5: found '1,5 0 0'");
  refuses("solid\n" + facet("vertex 0 0 0\nvertex 1 0 0\n"), "found a facet of 2 vertices");
  refuses("solid\nface 1 2 3\n", "line 2: found 'face'");
  EXPECT_EQ(read("solid\n" + stl_triangle).warnings.size(), 1u) << "no endsolid";
}

TEST_F(Stl, FloatsFarOutAreWarnedOfAndTextIsNot) {
  const auto warnings = read(binary_stl(1, 1, "x", 5e6f)).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("floats, which lie 0.5 m apart"), std::string::npos) << warnings[0];
  EXPECT_TRUE(read("solid\n" + facet("vertex 5000000.2 0 0\nvertex 5000001.2 0 0\nvertex 5000001.2 1 0\n") +
                   "endsolid\n")
                  .warnings.empty());
}

}  // namespace
}  // namespace tenebra
