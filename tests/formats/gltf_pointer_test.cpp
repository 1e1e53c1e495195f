// KHR_animation_pointer: nodes, lights and cameras move by it; what is not read is named; export keeps it.
#include <gtest/gtest.h>

#include <tenebra/frame_geometry.h>
#include "formats/gltf_builder.h"

namespace tenebra {
namespace {

using testing::contains;
using testing::GltfBuilder;
using testing::joined;
using testing::Json;

/// A triangle, a spot light, an area light and two cameras; channels are added by pointer.
struct Pointed : GltfBuilder {
  Pointed() {
    add_triangle();
    root["extensionsUsed"] = {"KHR_animation_pointer", "KHR_lights_punctual", "EXT_lights_area",
                              "KHR_node_visibility"};
    root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}}};
    root["extensions"]["EXT_lights_area"]["lights"] = {
        {{"type", "rect"}, {"size", 1}, {"rect", {{"aspect", 2}}}}};
    root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
                       {{"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}}};
    root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    root["nodes"].push_back({{"extensions", {{"EXT_lights_area", {{"light", 0}}}}}});
    root["nodes"].push_back({{"camera", 0}});
    root["nodes"].push_back({{"camera", 1}});
    root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    times_ = floats({0, 2}, "SCALAR", 1, true);
    root["animations"][0]["name"] = "all";
  }

  void drive(const std::string& pointer, const std::vector<float>& values, const char* type = "SCALAR") {
    const std::size_t output = floats(values, type, values.size() / 2);
    Json& animation = root["animations"][0];
    animation["samplers"].push_back({{"input", times_}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target",
          {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
  }

private:
  std::size_t times_ = 0;
};

Pointed everything() {
  Pointed file;
  const std::string spot = "/extensions/KHR_lights_punctual/lights/0/",
                    area = "/extensions/EXT_lights_area/lights/0/";
  file.drive("/nodes/0/translation", {0, 0, 0, 4, 0, 0}, "VEC3");
  file.drive(spot + "color", {1, 1, 1, 0, 1, 0}, "VEC3");
  file.drive(spot + "intensity", {10, 30});
  file.drive(spot + "range", {5, 7});
  file.drive(spot + "spot/innerConeAngle", {0.1f, 0.3f});
  file.drive(spot + "spot/outerConeAngle", {0.4f, 0.8f});
  file.drive(area + "size", {1, 3});
  file.drive(area + "intensity", {1, 5});
  file.drive("/cameras/0/perspective/yfov", {1, 0.5f});
  file.drive("/cameras/0/perspective/znear", {0.1f, 0.3f});
  file.drive("/cameras/1/orthographic/ymag", {1, 4});
  return file;
}

void expect_half_way(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, 0, 1, frame);
  EXPECT_FLOAT_EQ(frame.positions[0].x, 2);
  const auto lights = evaluate_lights(scene, 0, 1);
  ASSERT_EQ(lights.size(), 2u);
  const Light spot = light_at(scene, lights[0]), area = light_at(scene, lights[1]);
  EXPECT_EQ(spot.color, glm::vec3(0.5f, 1, 0.5f));
  EXPECT_FLOAT_EQ(spot.intensity, 20);
  EXPECT_FLOAT_EQ(spot.range_m.value(), 6);
  EXPECT_FLOAT_EQ(spot.inner_cone_rad, 0.2f);
  EXPECT_FLOAT_EQ(spot.outer_cone_rad, 0.6f);
  EXPECT_FLOAT_EQ(area.intensity, 3);
  EXPECT_EQ(area.color, glm::vec3(1));
  EXPECT_FLOAT_EQ(lights[1].axis_x.x, 2);  // half of 2 m times the aspect of 2
  EXPECT_FLOAT_EQ(lights[1].axis_y.y, 1);
  const ViewRays first = evaluate_camera(scene, 0, 1, 0, 100, 100),
                 second = evaluate_camera(scene, 0, 1, 1, 100, 100);
  EXPECT_NEAR(first.d0.y, std::tan(0.375), 1e-6);
  EXPECT_FLOAT_EQ(first.near_m, 0.2f);
  EXPECT_FLOAT_EQ(second.dy.y * -100, 5);
  // Without a clip everything is as the tables say.
  EXPECT_FLOAT_EQ(light_at(scene, evaluate_lights(scene, -1, 1)[0]).intensity, scene.lights[0].intensity);
  EXPECT_NEAR(evaluate_camera(scene, -1, 1, 0, 100, 100).d0.y, std::tan(0.5), 1e-6);
}

TEST(AnimationPointers, DriveNodesLightsAndCameras) {
  const auto scene = everything().import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(scene->warnings.empty()) << joined(scene->warnings);
  expect_half_way(*scene);
}

TEST(AnimationPointers, ComeBackThroughExport) {
  const auto scene = everything().import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  const testing::TemporaryFolder folder;
  const auto losses = formats::export_glb(*scene, folder / "out.glb");
  ASSERT_TRUE(losses.has_value()) << losses.error().message;
  const auto again = formats::import_gltf(folder / "out.glb");
  ASSERT_TRUE(again.has_value()) << again.error().message;
  expect_half_way(*again);
}

TEST(AnimationPointers, HideNodes) {
  Pointed file;
  const std::size_t output = file.accessor<std::uint8_t>({1, 0}, 5121, "SCALAR", 1);
  file.drive("/nodes/0/extensions/KHR_node_visibility/visible", {1, 0});
  file.root["animations"][0]["samplers"][0] = {{"input", file.root["animations"][0]["samplers"][0]["input"]},
                                               {"output", output},
                                               {"interpolation", "STEP"}};
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  FrameGeometry frame;
  evaluate_frame(*scene, 0, 1, frame);
  EXPECT_EQ(frame.triangles[0], glm::uvec3(0, 1, 2));
  evaluate_frame(*scene, 0, 2, frame);
  EXPECT_EQ(frame.triangles[0], glm::uvec3(0));
}

TEST(AnimationPointers, ThatAreNotReadAreNamed) {
  Pointed file;
  file.drive("/materials/0/pbrMetallicRoughness/roughnessFactor", {0, 1});
  file.drive("/nodes/9/translation", {0, 0, 0, 0, 0, 0}, "VEC3");
  file.drive("/nodes/0/scale", {1, 1, 1, 2, 2, 2}, "VEC3");
  const auto scene = file.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(contains(scene->warnings,
                       "animations[0]: 2 of 3 channels drive what is not read: "
                       "/materials/0/pbrMetallicRoughness/roughnessFactor, /nodes/9/translation."))
      << joined(scene->warnings);
  EXPECT_EQ(scene->clips[0].channels.size(), 1u);
}

TEST(AnimationPointers, OfWrongFormatsAreRefusedAndTheLaterOfTwoCounts) {
  Pointed vector;
  vector.drive("/cameras/0/perspective/yfov", {0, 0, 0, 0, 0, 0}, "VEC3");
  EXPECT_FALSE(vector.import().has_value());
  Pointed twice;
  twice.drive("/cameras/0/perspective/yfov", {1, 1});
  twice.drive("/cameras/0/perspective/yfov", {2, 2});
  const auto scene = twice.import();
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(std::any_of(scene->warnings.begin(), scene->warnings.end(), [](const std::string& warning) {
    return warning.find("driven twice") != std::string::npos;
  })) << joined(scene->warnings);
  EXPECT_NEAR(evaluate_camera(*scene, 0, 1, 0, 100, 100).d0.y, std::tan(1.0), 1e-6);
}

TEST(AnimationPointers, OfTheSampleOfSeventyFourAreReadOrNamed) {
  const auto path = std::filesystem::path(TENEBRA_SHARED_DIR) /
                    "scenes/extra/gltf/khronos_blender_io_24_animation_pointer/24_animation_pointer.gltf";
  // Models of others have licences of their own: they lie beside the checkout, not in it.
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the folder of extra scenes is not beside the checkout";
  const auto scene = formats::import_gltf(path);
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_TRUE(contains(scene->warnings, "channels drive what is not read: /materials/2/"))
      << joined(scene->warnings);
  EXPECT_FALSE(contains(scene->warnings, "/nodes/")) << joined(scene->warnings);
  ASSERT_EQ(scene->clips.size(), 1u);
  const auto lights = evaluate_lights(*scene, 0, 1), later = evaluate_lights(*scene, 0, 4);
  ASSERT_EQ(lights.size(), later.size());
  bool changes = false;
  for (std::size_t i = 0; i < lights.size(); ++i)
    changes |= light_at(*scene, lights[i]).color != light_at(*scene, later[i]).color;
  EXPECT_TRUE(changes);
}

}  // namespace
}  // namespace tenebra
