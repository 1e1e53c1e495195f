// Skin weights: sums that are not 1, eight influences, and both back through export_glb.
#include <gtest/gtest.h>

#include <tenebra/frame_geometry.h>
#include "formats/gltf_builder.h"

namespace tenebra {
namespace {

using testing::contains;
using testing::GltfBuilder;
using testing::joined;
using testing::Json;

/// A triangle carried by `joints` nodes, node i at (0, 0, i); the bind pose is at the origin.
struct Carried : GltfBuilder {
  explicit Carried(std::size_t joints) {
    add_triangle();
    root["nodes"][0]["skin"] = 0;
    root["nodes"].push_back({{"name", "root"}});
    root["scenes"][0]["nodes"] = {0, 1};
    for (std::size_t i = 0; i < joints; ++i) {
      root["nodes"].push_back({{"translation", {0, 0, i}}});
      root["nodes"][1]["children"].push_back(2 + i);
      root["skins"][0]["joints"].push_back(2 + i);
    }
  }
  Json& attributes() { return root["meshes"][0]["primitives"][0]["attributes"]; }
};

float height(const Scene& scene, std::size_t vertex) {
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  return frame.positions[vertex].z;
}

TEST(SkinWeights, AreMadeToSumToOneWithAWarning) {
  Carried file(3);
  file.attributes()["JOINTS_0"] =
      file.accessor<std::uint8_t>({0, 1, 2, 0, 1, 2, 0, 0, 2, 0, 0, 0}, 5121, "VEC4", 4);
  // 0.5 of 0 and 2; right; all zeros, which the first joint takes.
  file.attributes()["WEIGHTS_0"] = file.floats({0.25f, 0, 0.25f, 0, 0.5f, 0.5f, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(contains(scene->warnings, "found 2 vertices whose skin weights do not sum to 1"))
      << joined(scene->warnings);
  EXPECT_FLOAT_EQ(height(*scene, 0), 1);     // between 0 and 2
  EXPECT_FLOAT_EQ(height(*scene, 1), 1.5f);  // between 1 and 2
  EXPECT_FLOAT_EQ(height(*scene, 2), 2);
}

TEST(SkinWeights, OfEightJointsAllCount) {
  Carried file(8);
  const std::vector<std::uint16_t> low = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
                                   high = {4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7};
  file.attributes()["JOINTS_0"] = file.accessor(low, 5123, "VEC4", 4);
  file.attributes()["JOINTS_1"] = file.accessor(high, 5123, "VEC4", 4);
  file.attributes()["WEIGHTS_0"] =
      file.floats({0.125f, 0.125f, 0.125f, 0.125f, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  file.attributes()["WEIGHTS_1"] =
      file.floats({0.125f, 0.125f, 0.125f, 0.125f, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC4", 4);
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
  EXPECT_FLOAT_EQ(height(*scene, 0), 3.5f);
  EXPECT_FLOAT_EQ(height(*scene, 1), 0);
  EXPECT_FLOAT_EQ(height(*scene, 2), 7);

  const testing::TemporaryFolder folder;
  ASSERT_TRUE(formats::export_glb(*scene, folder / "out.glb").has_value());
  const auto again = formats::import_gltf(folder / "out.glb");
  ASSERT_TRUE(again.has_value()) << again.error().message;
  for (std::size_t v = 0; v < 3; ++v) EXPECT_EQ(height(*again, v), height(*scene, v));
}

TEST(SkinWeights, JointsBeyondTheSkinAreRefusedInBothSets) {
  for (const int set : {0, 1}) {
    Carried file(2);
    for (const int k : {0, 1}) {
      const auto joint = static_cast<std::uint8_t>(k == set ? 2 : 0);
      file.attributes()["JOINTS_" + std::to_string(k)] =
          file.accessor<std::uint8_t>({joint, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4);
      file.attributes()["WEIGHTS_" + std::to_string(k)] =
          file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    }
    const auto scene = file.import();
    ASSERT_FALSE(scene.has_value());
    EXPECT_NE(scene.error().message.find("JOINTS_" + std::to_string(set) + ": found joint 2"),
              std::string::npos)
        << scene.error().message;
  }
}

}  // namespace
}  // namespace tenebra
