// What the converter keeps of a scene beside its triangles: morph targets and highlights.
#include <gtest/gtest.h>

#include <tenebra/frame_geometry.h>
#include "formats/converted.h"
#include "formats/import_scene.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

/// A triangle, 1 cm high, that grows to 3 cm within a second, with a highlight.
constexpr const char* growing_fbx = R"(; FBX 7.3.0 project file
FBXHeaderExtension: {
 FBXVersion: 7300
}
Objects: {
 Geometry: 1, "Geometry::g", "Mesh" {
  Vertices: *9 {
   a: 0,0,0,1,0,0,0,1,0
  }
  PolygonVertexIndex: *3 {
   a: 0,1,-3
  }
  GeometryVersion: 124
  LayerElementMaterial: 0 {
   Version: 101
   Name: ""
   MappingInformationType: "AllSame"
   ReferenceInformationType: "IndexToDirect"
   Materials: *1 {
    a: 0
   }
  }
  Layer: 0 {
   Version: 100
   LayerElement: {
    Type: "LayerElementMaterial"
    TypedIndex: 0
   }
  }
 }
 Geometry: 5, "Geometry::tall", "Shape" {
  Version: 100
  Indexes: *1 {
   a: 2
  }
  Vertices: *3 {
   a: 0,2,0
  }
  Normals: *3 {
   a: 0,0,0
  }
 }
 Model: 2, "Model::m", "Mesh" {
  Version: 232
 }
 Material: 3, "Material::shiny", "" {
  Version: 102
  ShadingModel: "phong"
  Properties70: {
   P: "DiffuseColor", "Color", "", "A",0.2,0.4,0.6
   P: "SpecularColor", "Color", "", "A",1,0.5,0.25
   P: "SpecularFactor", "Number", "", "A",0.5
   P: "ShininessExponent", "Number", "", "A",30
  }
 }
 Deformer: 6, "Deformer::shapes", "BlendShape" {
  Version: 100
 }
 Deformer: 7, "SubDeformer::tall", "BlendShapeChannel" {
  Version: 100
  DeformPercent: 0
  FullWeights: *1 {
   a: 100
  }
 }
 AnimationStack: 10, "AnimStack::s", "" {
  Properties70: {
   P: "LocalStop", "KTime", "Time", "",46186158000
  }
 }
 AnimationLayer: 11, "AnimLayer::l", "" {
 }
 AnimationCurveNode: 12, "AnimCurveNode::DeformPercent", "" {
  Properties70: {
   P: "d|DeformPercent", "Number", "", "A",0
  }
 }
 AnimationCurve: 13, "AnimCurve::", "" {
  Default: 0
  KeyVer: 4008
  KeyTime: *2 {
   a: 0,46186158000
  }
  KeyValueFloat: *2 {
   a: 0,100
  }
  KeyAttrFlags: *1 {
   a: 24840
  }
  KeyAttrDataFloat: *4 {
   a: 0,0,0,0
  }
  KeyAttrRefCount: *1 {
   a: 2
  }
 }
}
Connections: {
 C: "OO",2,0
 C: "OO",1,2
 C: "OO",3,2
 C: "OO",6,1
 C: "OO",7,6
 C: "OO",5,7
 C: "OO",11,10
 C: "OO",12,11
 C: "OP",12,7,"DeformPercent"
 C: "OP",13,12,"d|DeformPercent"
}
)";

class AssimpParts : public ::testing::Test {
protected:
  void SetUp() override {
    if (formats::find_converter().program.empty())
      GTEST_SKIP() << "built without Assimp (package libassimp-dev)";
  }
  static Scene read(const std::string& text) {
    const testing::TemporaryFolder folder;
    testing::write_text(folder / "a.fbx", text);
    auto scene = formats::import_scene(folder / "a.fbx");
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
};

TEST_F(AssimpParts, MorphTargetsAndTheirAnimation) {
  const Scene scene = read(growing_fbx);
  ASSERT_EQ(scene.clips.size(), 1u);
  FrameGeometry frame;
  for (const double time : {0.0, 0.5, 1.0}) {
    evaluate_frame(scene, 0, time, frame);
    EXPECT_NEAR(frame.positions.at(2).y, 0.01 * (1 + 2 * time), 1e-8) << time;  // roundings of .03
  }
}

TEST_F(AssimpParts, HighlightsKeepTheirNumbers) {
  const Scene scene = read(growing_fbx);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].model, SurfaceModel::phong);
  EXPECT_EQ(scene.materials[0].specular, glm::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(scene.materials[0].phong_exponent, 30);
  std::string matte = growing_fbx;
  matte.replace(matte.find("phong"), 5, "lambert");
  EXPECT_NE(read(matte).materials.at(0).model, SurfaceModel::phong);
}

}  // namespace
}  // namespace tenebra
