// Files that other programs wrote (../shared/cases): each is read as its README says is right. What their
// masks show is compared with exact arithmetic on the files' own numbers by verify.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/import_scene.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path cases = fs::path(TENEBRA_SHARED_DIR) / "cases";

class SharedCases : public ::testing::Test {
protected:
  void SetUp() override {
    if (!fs::exists(cases)) GTEST_SKIP() << "the files of other programs are not beside this checkout";
  }

  /// The bytes of the mask at the start.
  std::string mask(const std::string& file) {
    const auto result = tenebra({"render", cases / file, "-o", "none", "--mask", folder_ / "m.png",
                                 "--frames", "0", "--size", "80x60", "--raster", "cpu", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << file << ": " << result.errors;
    return read_text(folder_ / "m.png");
  }

  static void expect_verified(const std::string& file) {
    EXPECT_EQ(tenebra({"verify", cases / file, "--size", "80x60", "--raster", "cpu", "--quiet"}).exit_code, 0)
        << file;
  }

  static Json info(const std::string& file) {
    return Json::parse(tenebra({"info", cases / file, "--json"}).output);
  }

  /// What render says beside its pictures.
  std::string said(const std::string& file, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"render", cases / file, "-o", folder_ / "p.png", "--frames", "0", "--size",
                               "80x60", "--raster", "cpu"});
    const auto result = tenebra(more);
    EXPECT_EQ(result.exit_code, 0) << file << ": " << result.errors;
    return result.errors;
  }

  TemporaryFolder folder_;
};

TEST_F(SharedCases, OneBoxIsReadTheSameHoweverItIsWritten) {
  const std::vector<std::string> files{"gltf-bom/m.gltf",
                                       "glb-unaligned/m.glb",
                                       "gltf-scene-lists-child/gltf-scene-lists-child/m.gltf",
                                       "gltf-scene-lists-child/gltf-scene-lists-only-child/m.gltf",
                                       "gltf-far-from-origin/gltf-offset-1e3/m.gltf",
                                       "gltf-far-from-origin/gltf-offset-1e6/m.gltf",
                                       "gltf-far-from-origin/gltf-offset-1e7/m.gltf"};
  const std::string first = mask(files[0]);
  for (const std::string& file : files) {
    EXPECT_EQ(mask(file), first) << file;
    EXPECT_EQ(info(file)["counts"]["triangles"], 14) << file;
    expect_verified(file);
  }
}

TEST_F(SharedCases, OthersOfGltfAreReadAndVerified) {
  for (const std::string name :
       {"gltf-unaligned-accessor", "gltf-joints-of-two-roots", "gltf-orthographic-znear-zero",
        "gltf-property-driven-twice", "gltf-lamp-above-ceiling"})
    expect_verified(name + "/m.gltf");
  for (const std::string name :
       {"gltf-unaligned-accessor", "gltf-joints-of-two-roots", "gltf-property-driven-twice"})
    EXPECT_EQ(info(name + "/m.gltf")["warnings"].size(), 1u) << name;
  EXPECT_EQ(mask("gltf-lamp-above-ceiling/m.gltf"), mask("gltf-empty-scene-silent/m.gltf"))
      << "nothing is lit";
  EXPECT_NE(said("gltf-empty-scene-silent/m.gltf").find("no triangles"), std::string::npos);
}

TEST_F(SharedCases, OneCubeIsReadTheSameHoweverItIsWritten) {
  const std::vector<std::string> files{"obj-bom/obj-bom-vertex/m.obj",
                                       "obj-bom/obj-bom-mtllib/m.obj",
                                       "obj-bom/obj-bom-in-mtl/m.obj",
                                       "obj-decimal-comma/obj-mtl-comma/m.obj",
                                       "obj-mtllib-with-spaces/obj-unicode/Brücke ñ 日本.obj",
                                       "obj-comment-behind-face/obj-comments-inline/m.obj",
                                       "obj-meshlab-tr/m.obj"};
  const std::string first = mask(files[0]);
  for (const std::string& file : files) {
    EXPECT_EQ(mask(file), first) << file;
    EXPECT_EQ(info(file)["counts"]["triangles"], 12) << file;
    expect_verified(file);
  }
}

TEST_F(SharedCases, OneTetrahedronIsReadTheSameHoweverItIsWritten) {
  const std::string first = mask("obj-comment-behind-face/obj-f-comment/m.obj");
  for (const std::string file :
       {"obj-missing-normals/obj-missing-vn/m.obj", "obj-missing-normals/obj-missing-vt/m.obj",
        "obj-mtllib-with-spaces/obj-mtl-space/my model.obj"}) {
    EXPECT_EQ(mask(file), first) << file;
    EXPECT_EQ(info(file)["counts"]["triangles"], 4) << file;
    expect_verified(file);
  }
}

TEST_F(SharedCases, MaterialsAreFound) {
  for (const std::string file :
       {"obj-bom/obj-bom-mtllib/m.obj", "obj-bom/obj-bom-in-mtl/m.obj",
        "obj-mtllib-with-spaces/obj-mtl-space/my model.obj",
        "obj-mtllib-with-spaces/obj-unicode/Brücke ñ 日本.obj", "obj-decimal-comma/obj-mtl-comma/m.obj"}) {
    const auto scene = formats::import_scene(cases / file);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_FALSE(scene->materials.empty()) << file;
    EXPECT_NE(scene->materials[0].base_color, Material{}.base_color) << file;
  }
  EXPECT_EQ(info("obj-colours-of-some/m.obj")["triangles_with"]["vertex_colors"], 12);
}

TEST_F(SharedCases, DecimalCommasInPlacesAreRefusedWithTheirLine) {
  const auto result = tenebra({"info", cases / "obj-decimal-comma/obj-decimal-comma/m.obj"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.errors.find("line 1: found '0,25'"), std::string::npos) << result.errors;
}

TEST_F(SharedCases, FacesOfManyCornersKeepTheirArea) {
  for (const int corners : {256, 260, 300}) {
    const std::string file = "obj-polygon-over-255-corners/obj-" + std::to_string(corners) + "-corners/m.obj";
    const auto scene = formats::import_scene(cases / file);
    ASSERT_TRUE(scene) << scene.error().message;
    double area = 0;
    for (const Mesh& mesh : scene->meshes)
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += glm::length(glm::cross(b - a, c - a)) / 2;
      }
    EXPECT_NEAR(area, 1 + corners / 2.0 * std::sin(2 * std::numbers::pi / corners), 1e-5) << file;
    EXPECT_EQ(info(file)["counts"]["triangles"], corners);
    expect_verified(file);
  }
}

TEST_F(SharedCases, AHouseOnAMapIsTheHouseAtTheOrigin) {
  EXPECT_EQ(mask("obj-georeferenced/obj-utm/m.obj"), mask("obj-georeferenced/obj-utm-shifted/m.obj"));
  for (const std::string name : {"obj-utm", "obj-utm-gap", "obj-double-precision"})
    expect_verified("obj-georeferenced/" + name + "/m.obj");
  EXPECT_EQ(info("obj-georeferenced/obj-utm/m.obj")["bounds_m"]["low"][2], -5812375.25);
}

TEST_F(SharedCases, LightsOfTheUsersTakeThePlaceOfTheInventedSun) {
  for (const std::string& words :
       {said("add-light-adds-sun-too/m.obj", {"--add-light", "point position=5,12,5 intensity=500"}),
        said("emissive-lights-add-sun-too/m.gltf", {"--shadows", "soft", "--emissive-lights"})})
    EXPECT_EQ(words.find("has no light"), std::string::npos) << words;
}

}  // namespace
}  // namespace tenebra::testing
