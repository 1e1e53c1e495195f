// Small AFF texts: each directive, each trap, and what must be refused in a sentence.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <tenebra/frame_geometry.h>
#include "formats/import_scene.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;

class AffText : public ::testing::Test {
protected:
  AffText() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("tenebra_aff_" + std::string(info->name()) + std::to_string(getpid()));
    fs::create_directories(folder_ / "scene");
  }
  ~AffText() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / "scene" / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  Expected<Scene> read(const std::string& text) const {
    return formats::import_aff(write("a.aff", text), {});
  }
  Scene scene(const std::string& text) const {
    Expected<Scene> result = read(text);
    EXPECT_TRUE(result.has_value()) << result.error().message;
    return result ? std::move(*result) : Scene{};
  }
  void expect_refused(const std::string& text, const std::string& part) const {
    const Expected<Scene> result = read(text);
    ASSERT_FALSE(result.has_value()) << text.substr(0, 80);
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().message.find("expected"), std::string::npos) << result.error().message;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
  }

  fs::path folder_;
};

FrameGeometry frame_of(const Scene& scene, double time_s = 0.0) {
  FrameGeometry frame;
  evaluate_frame(scene, 0, time_s, frame);
  return frame;
}

const std::string triangle = "p 3  0 0 0  1 0 0  0 1 0\n";

TEST_F(AffText, CommentsCarriageReturnsAndLatin1AreBlanks) {
  const Scene s = scene("#{ caf\xe9 {\r\nb .5 +1. 5e-1%comment\r\np 3 0 0 0 # in\r\n 1 0 0 0 1 -0\r\n% end");
  EXPECT_EQ(s.background, glm::vec3(0.5f, 1.0f, 0.5f));
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.meshes[0].source, "a.aff:3");
}

TEST_F(AffText, PolygonsAreFansAndConsecutiveOnesShareAMesh) {
  const Scene s =
      scene("p 4 0 0 0 1 0 0 1 1 0 0 1 0\n" + triangle + "pp 3 0 0 0 0 0 2 1 0 0 0 0 0 0 1 0 0 0 1\n");
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(s.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(s.meshes[1].normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(s.meshes[1].normals[1], glm::vec3(0.0f));
  EXPECT_EQ(s.meshes[1].source, "a.aff:3");
}

TEST_F(AffText, TexturedTrianglesWithoutTheirPictureAreTriangles) {
  const Scene s = scene(
      "tt a.ppm 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1\nttp a.ppm 0 0 0 0 0 1 0 0 1 0 0 0 0 1 1 0 0 1 0 0 0 1 0 1\n");
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(s.meshes[0].positions[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(s.meshes[1].normals[2], glm::vec3(0, 0, 1));
}

TEST_F(AffText, MeshIndicesAreGroupedByKind) {
  const Scene s = scene(
      "m vertices 3 0 0 0 1 0 0 0 1 0 normals 2 0 0 3 0 1 0 texturecoords 1 t.ppm 0 0 "
      "triangles 2 0 1 2 0 1 0 0 0 0   2 1 0 0 0 0 0 0 0");
  ASSERT_EQ(s.meshes.size(), 1u);
  const Mesh& m = s.meshes[0];
  ASSERT_EQ(m.triangles.size(), 2u);
  EXPECT_EQ(m.positions.size(), 4u);
  const glm::uvec3 t = m.triangles[0];
  EXPECT_EQ(m.positions[t.y], glm::vec3(1, 0, 0));
  EXPECT_EQ(m.normals[t.x], glm::vec3(0, 0, 1));
  EXPECT_EQ(m.normals[t.y], glm::vec3(0, 1, 0));
}

TEST_F(AffText, MaterialsSurviveBracesAndIncludes) {
  write("red.aff", "fm 0 0 0 1 0 0 0 0 0 1 0 1\n");
  const Scene s = scene("f 0 1 0 .5 .5 1 0 1\nxs 1 1 1 0 0 0 0 0 0 0 { i 0 red.aff }\n" + triangle);
  EXPECT_EQ(s.materials.at(s.meshes.at(0).materials.at(0)).base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(s.materials[0].base_color, glm::vec3(0, 0.5f, 0));
}

TEST_F(AffText, TransformsScaleThenRotateThenTranslate) {
  const Scene s = scene("xs 2 1 1  0 0 3 90  5 0 0 { xs 1 1 1 0 0 0 45 0 1 0 { " + triangle + "} }");
  const FrameGeometry frame = frame_of(s);
  EXPECT_NEAR(glm::length(frame.positions[1] - glm::vec3(4, 2, 0)), 0, 1e-6);
}

TEST_F(AffText, KeysMayComeBeforeOrAfterAndRepeat) {
  const std::string keys = "k a { transl 4 0 1 2 3 0 0 0 1 1 2 3 0 0 0 2 1 2 3 0 0 0 3 1 2 3 0 0 0 }\n";
  for (const std::string& text : {keys + "x a { " + triangle + "}", "x a{ " + triangle + keys + "}" + keys}) {
    const Scene s = scene(text);
    EXPECT_EQ(frame_of(s).positions.at(0), glm::vec3(1, 2, 3));
    EXPECT_TRUE(s.warnings.empty());
    EXPECT_EQ(s.clips.at(0).start_s, 1.0);  // no `a`: the reachable keys
    EXPECT_EQ(s.clips[0].end_s, 2.0);
  }
  const Scene conflict = scene(keys + "k a { }\nx a {" + triangle + "}");
  EXPECT_EQ(frame_of(conflict).positions.at(0), glm::vec3(0.0f));
  EXPECT_NE(conflict.warnings.at(0).find("'a'"), std::string::npos);
}

TEST_F(AffText, NamesWithoutKeysStandStill) {
  const Scene s = scene("x nobody { " + triangle + "}");
  EXPECT_NE(s.warnings.at(0).find("'nobody'"), std::string::npos);
  EXPECT_EQ(frame_of(s).positions.at(1), glm::vec3(1, 0, 0));
}

TEST_F(AffText, VisibilityHidesTheSubtreeFromItsKeyOn) {
  const Scene s = scene("k a { visibility 2 1 0  2 1 }\nx a { xs 1 1 1 0 0 0 0 0 0 0 { " + triangle + "} }");
  EXPECT_EQ(frame_of(s, -50.0).triangles.at(0), glm::uvec3(0, 1, 2));
  EXPECT_EQ(frame_of(s, 1.0).triangles.at(0), glm::uvec3(0));
  EXPECT_EQ(frame_of(s, 2.0).triangles.at(0), glm::uvec3(0, 1, 2));
}

TEST_F(AffText, DetailLevelsSelectIncludes) {
  write("b.aff", triangle);
  EXPECT_EQ(scene("i 1 b.aff\ni 2 missing.aff").meshes.size(), 0u);
  EXPECT_EQ(scene("d 1\ni 1 b.aff\ni 0 b.aff").meshes.size(), 2u);
}

TEST_F(AffText, LightsMayHaveColoursAndKeys) {
  const Scene s = scene(
      "l 1 2 3\nl 1 2 3 .1 .2 .3\nla lamp 0 0 0\nk lamp { transl 4 0 7 8 9 0 0 0 1 7 8 9 0 0 0 2 7 8 9 0 0 0 "
      "3 7 8 9 0 0 0 }");
  const std::vector<WorldLight> lights = evaluate_lights(s, 0, 1.0);
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(s.lights[0].color, glm::vec3(1.0f));
  EXPECT_EQ(s.lights[1].color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(lights[2].position, glm::vec3(7, 8, 9));
}

TEST_F(AffText, ViewPlacesTheCamera) {
  const Scene s = scene("v from 0 0 5 at 0 0 0 up 0 1 0 angle 90 hither 0 resolution 200 100");
  const ViewRays view = evaluate_camera(s, -1, 0, 0, 2, 2);
  EXPECT_EQ(view.eye, glm::vec3(0, 0, 5));
  EXPECT_NEAR(glm::length(view.d0 - glm::vec3(-1, 1, -1)), 0, 1e-6);
  EXPECT_EQ(view.near_m, 1.0f);
  EXPECT_EQ(s.cameras.at(0).aspect, 2.0f);
}

TEST_F(AffText, RoundShapesFaceOutwardsUnlessNegative) {
  const auto outward_share = [&](const std::string& text) {
    const Mesh mesh = scene(text).meshes.at(0);
    int outward = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      const glm::vec3 n = glm::cross(b - a, c - a);
      outward += glm::dot(n, a + b + c) > 0;
      EXPECT_GT(glm::dot(n, mesh.normals[t.x]), 0.0f);
    }
    return static_cast<double>(outward) / static_cast<double>(mesh.triangles.size());
  };
  EXPECT_EQ(outward_share("s 0 0 0 1"), 1.0);
  EXPECT_EQ(outward_share("s 0 0 0 -1"), 0.0);
  EXPECT_EQ(outward_share("c 0 -1 0 1 0 1 0 1"), 1.0);
  EXPECT_EQ(outward_share("c 0 -1 0 -1 0 1 0 -1"), 0.0);
  EXPECT_EQ(scene("c 0 -1 0 1 0 1 0 0").meshes[0].triangles.size(), 64u);
  EXPECT_EQ(scene("c 0 -1 0 1 0 1 0 1").meshes[0].triangles.size(), 128u);
}

TEST_F(AffText, AnimatedTrianglesAreLinearAndGroupedByTheirTimes) {
  const std::string key0 = " 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1",
                    key2 = " 2 0 0 4 0 0 3 1 0 4 0 0 3 0 1 4 0 0 3";
  const std::string key3 = " 3 0 0 4 0 0 3 1 0 4 0 0 3 0 1 4 0 0 3";
  const Scene s = scene("tpa 2" + key0 + key2 + "\ntpa 2" + key0 + key2 + "\ntpa 2" + key0 + key3);
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(s.meshes[0].triangles.size(), 2u);
  EXPECT_EQ(frame_of(s, 0.5).positions.at(3), glm::vec3(0, 0, 1));
  EXPECT_EQ(frame_of(s, 9.0).positions.at(8), glm::vec3(0, 1, 4));
  EXPECT_EQ(frame_of(s, 1.0).normals.at(0), glm::vec3(0, 0, 1));
}

TEST_F(AffText, RefusesWhatItCannotReadInOneSentence) {
  expect_refused("q 1 2", "a.aff:1: found 'q'");
  expect_refused("\n\nb 1 x", "a.aff:3: found 'x'");
  expect_refused("p 3 0 0 0 nan 0 0 0 1 0", "'nan'");
  expect_refused("l 1 inf 0", "'inf'");
  expect_refused("b 1e999 0 0", "'1e999'");
  expect_refused("b 1 2", "the end of the file");
  expect_refused("p 2.5 0 0 0 1 1 1", "2.5");
  expect_refused("p 2 0 0 0 1 1", "the end of the file");
  expect_refused("p 2000000000 0 0 0", "the end of the file");
  expect_refused("p 99999999999999999999 0 0 0", "99999999999999999999");
  expect_refused("m vertices -1", "-1");
  expect_refused("m vertices 2147483647 0 0 0", "the end of the file");
  expect_refused("m vertices 1 0 0 0 triangles 1 0 0 1", "found 1");
  expect_refused("m vertices 1 0 0 0 faces", "'triangles'");
  expect_refused("xs 1 1 1 0 0 0 0 0 0 0 {\n", "opened at a.aff:1");
  expect_refused("}", "'}'");
  expect_refused("k a { transl 3 0 0 0 0 0 0 0 }", "at least 4");
  expect_refused("k a { visibility 1 0 2 }", "0 or 1");
  expect_refused("c 0 0 0 1 0 0 0 2", "one point");
  expect_refused("c 0 0 0 1 0 1 0 -1", "radii");
  expect_refused("\x01\xff", "\\x01\\xff");
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "x a {";
  expect_refused(deep, "1024");
}

TEST_F(AffText, FaultsThatLeaveTheGeometryCertainAreWarnedOf) {
  const auto faulty = [&](const std::string& text, const std::string& sentence) {
    Scene s = scene(text + "\n" + triangle);
    EXPECT_EQ(s.warnings, std::vector<std::string>{"a.aff:1: found " + sentence}) << text;
    EXPECT_EQ(frame_of(s).triangles.back(), glm::uvec3(0, 1, 2) + glm::uvec3(frame_of(s).triangles.back().x));
    return s;
  };
  EXPECT_EQ(faulty("b 1 -NaN 0", "'-NaN', expected a value of a colour; made 0.").background,
            glm::vec3(1, 0, 0));
  EXPECT_EQ(faulty("l 0 9 0 1 Infinity 1", "'Infinity', expected a value of the light's colour; made 0.")
                .lights.at(0)
                .color,
            glm::vec3(1, 0, 1));
  faulty("fm 0 0 0 inf 1 1 0 0 0 1 0 1", "'inf', expected one of a material's 12 numbers; made 0.");
  faulty("f 1 1 1 nan 0 0 0 1", "'nan', expected one of a material's 8 numbers; made 0.");
  EXPECT_EQ(faulty("p 2 0 0 0 1 1 1", "2 corners, expected at least 3; left out.").meshes.size(), 1u);
  faulty("pp 1 0 0 0 0 0 1", "1 corners, expected at least 3; left out.");
  faulty("tpa 0", "0 keys, expected at least one; left out.");
  faulty("c 0 0 0 1 0 0 0 1",
         "a cone's base and apex at one point, expected two points; it is a line, left out.");
  EXPECT_TRUE(
      faulty("a 0 1 0", "0 frames, expected at least one frame; the rate says how many.").clips.at(0).end_s ==
      1);
  EXPECT_TRUE(
      faulty("a 1 0 5", "0, expected an end after the animation's start; the keys say both.").clips.empty());
  faulty("v from 0 0 0 at 0 0 1 up 0 1 0 angle 180 hither 1 resolution -1 1",
         "180, expected an angle between 0 and 180 degrees; made 45.");
}

TEST_F(AffText, FaultyNormalsAreTheFacesAndFaultyCoordinatesACorner) {
  const Scene normals = scene("m vertices 3 0 0 0 1 0 0 0 1 0 normals 1 0 0 nan triangles 1 0 1 2 0 0 7");
  ASSERT_EQ(normals.warnings.size(), 2u);
  EXPECT_EQ(normals.warnings[1], "a.aff:1: found 7, expected a normal index below 1; left out.");
  EXPECT_EQ(normals.meshes.at(0).normals.at(0), glm::vec3(0));
  EXPECT_EQ(normals.meshes[0].triangles.size(), 1u);
  const Scene corner = scene("m vertices 3 0 0 0 1 0 0 0 1 0 texturecoords 0 t.ppm triangles 1 0 1 2 0 0 0");
  EXPECT_EQ(corner.meshes.at(0).triangles.size(), 1u);
}

TEST_F(AffText, OfTwoTracksOfAKindTheLastCountsAndNoKeysAreNone) {
  const Scene s = scene("k a { visibility 1 0 1 visibility 1 0 0 transl 0 }\nx a { " + triangle + "}");
  ASSERT_EQ(s.warnings.size(), 2u);
  EXPECT_EQ(
      s.warnings[0],
      "a.aff:1: found a second visibility, expected each kind of key once in a block; the last is used.");
  EXPECT_EQ(s.warnings[1], "a.aff:1: found 0, expected at least 4 keys; left out.");
  EXPECT_EQ(frame_of(s, 1).triangles.at(0), glm::uvec3(0));
}

TEST_F(AffText, MarksOfEditorsAreNoWordsAndWholeNumbersMayHaveAPoint) {
  EXPECT_EQ(scene("\xEF\xBB\xBFp 3.0  0 0 0  1 0 0  0 1 0\r\n\x1a").meshes.at(0).triangles.size(), 1u);
}

TEST_F(AffText, OfManyFaultsTheFirstAreNamed) {
  std::string text;
  for (int i = 0; i < 30; ++i) text += "b nan 1 1\n";
  const Scene s = scene(text);
  ASSERT_EQ(s.warnings.size(), 21u);
  EXPECT_EQ(s.warnings[20], "a.aff: 10 more faults that leave the geometry certain.");
}

TEST_F(AffText, IncludesStayInTheFolderAndEnd) {
  write("loop.aff", "i 0 a.aff");
  expect_refused("i 0 loop.aff", "'a.aff', which is being read");
  expect_refused("i 0 a.aff", "cycle");
  expect_refused("i 0 /etc/hostname", "out of the scene's folder");
  expect_refused("i 0 ../secret.aff", "out of the scene's folder");
  std::ofstream(folder_ / "secret.aff") << triangle;
  fs::create_symlink(folder_ / "secret.aff", folder_ / "scene" / "link.aff");
  expect_refused("i 0 link.aff", "a link out of the scene's folder");
  expect_refused("i 0 .", "no regular file");
  expect_refused("i 0 " + std::string(5000, 'n'), "include");
  write("close.aff", "}");
  expect_refused("xs 1 1 1 0 0 0 0 0 0 0 { i 0 close.aff", "close.aff:1");
  EXPECT_FALSE(formats::import_aff(folder_ / "nowhere.aff", {}).has_value());
  EXPECT_FALSE(formats::import_aff(folder_, {}).has_value());
  for (int i = 0; i < 70; ++i) {
    write(fmt::format("n{}.aff", i), fmt::format("i 0 n{}.aff", i + 1));
  }
  expect_refused("i 0 n0.aff", "at most 64");
}

TEST_F(AffText, IncludesThatMultiplyAreBounded) {
  const auto start = std::chrono::steady_clock::now();
  for (const std::string& payload : {std::string(), triangle, std::string("s 0 0 0 1\n")}) {
    for (int i = 0; i < 40; ++i) {
      const std::string next = fmt::format("i 0 b{}.aff\n", i + 1);
      write(fmt::format("b{}.aff", i), payload + next + next);
    }
    write("b40.aff", payload);
    expect_refused("i 0 b0.aff", "b");
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(AffText, NumbersBeyondFloatsAreDroppedAndCounted) {
  const Scene s = scene("p 3 0 0 0 1e300 0 0 0 1 0\n" + triangle);
  const FrameGeometry frame = frame_of(s);
  EXPECT_EQ(frame.dropped_non_finite, 1u);
  EXPECT_EQ(frame.triangles, (std::vector<glm::uvec3>{{0, 0, 0}, {3, 4, 5}}));
}

/// Mutants of a text with every directive load or fail with a sentence; what loads can be evaluated.
TEST_F(AffText, MutantsLoadOrFailWithASentence) {
  write("inc.aff", triangle);
  const std::string seed =
      "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither .1 resolution 8 6\nb 1 1 1\nam 1 1 1\nl 0 9 0 1 1 "
      "1\nla lamp 1 1 1\n"
      "d 1\nf 1 1 1 .5 .5 3 0 1\nfm 1 1 1 1 1 1 1 1 1 5 0 1\ns 0 0 0 1\nc 0 0 0 1 0 1 0 1\n" +
      triangle +
      "tt t.ppm 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1\nm vertices 3 0 0 0 1 0 0 0 1 0 normals 1 0 0 1 triangles 1 0 "
      "1 2 0 0 0\n"
      "tpa 2 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 1 0 0 1 0 0 1 1 0 1 0 0 1 0 1 1 0 0 1\ni 0 inc.aff\n"
      "xs 1 2 3 0 1 0 45 1 1 1 { x a { p 3 0 0 0 1 0 0 0 1 0 } }\na 0 5 10\n"
      "k a { transl 4 0 1 2 3 0 0 0 1 4 2 3 0 1 0 2 1 5 3 0 0 0 3 1 2 3 0 0 0 rot 4 0 0 1 0 9 0 0 0 1 0 1 0 "
      "400 0 0 0"
      " 2 0 1 0 90 0 0 0 3 0 1 0 0 0 0 0 visibility 1 2 0 }\n";
  ASSERT_TRUE(read(seed).has_value()) << read(seed).error().message;
  const std::string bytes = "0123456789.-+eE{}#%\n xkmptsvcfa\xff";
  std::mt19937 random(2026);
  int loaded = 0, refused = 0;
  for (int mutant = 0; mutant < 4000; ++mutant) {
    std::string text = seed;
    for (unsigned edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = bytes[random() % bytes.size()];
          break;
        case 1:
          text.erase(at, 1 + random() % 9);
          break;
        case 2:
          text.insert(at, 1, bytes[random() % bytes.size()]);
          break;
        case 3:
          text.resize(std::max<std::size_t>(at, 1));
          break;
      }
      if (text.empty()) text.push_back(' ');
    }
    const Expected<Scene> result = read(text);
    if (result) {
      FrameGeometry frame;
      evaluate_frame(*result, 0, 1.5, frame);
      for (const glm::vec3& p : frame.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << text;
      ++loaded;
    } else {
      ASSERT_NE(result.error().message.find("expected"), std::string::npos) << result.error().message;
      ++refused;
    }
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace tenebra
