// Where a file's scene stands: what is subtracted, the up axis and the unit.
#include <gtest/gtest.h>

#include <tenebra/frame_geometry.h>
#include "formats/place_scene.h"
#include "gltf_builder.h"
#include "round_trip.h"
#include "scene/unrounded.h"

namespace tenebra {
namespace {

using formats::OffsetChoice;
using glm::dvec3;
using glm::vec3;
using testing::GltfBuilder;
using testing::Json;
using testing::TemporaryFolder;

/// A triangle under a node at (0, 0.75, 0) turned by 30 degrees, with a camera and a light beside it, under a
/// root at `place`.
GltfBuilder far_scene(const dvec3& place) {
  GltfBuilder file;
  file.add_triangle();
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  const Json child = {{"mesh", 0},
                      {"camera", 0},
                      {"rotation", {0, 0, 0.25881904510252074, 0.9659258262890683}},
                      {"translation", {0, 0.75, 0}},
                      {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  file.root["nodes"] = {{{"translation", {place.x, place.y, place.z}}, {"children", {1}}}, child};
  return file;
}

Scene import(const GltfBuilder& file, const formats::Placement& placement = {}) {
  const TemporaryFolder folder;
  file.write(folder);
  formats::ImportOptions options;
  options.placement = placement;
  auto scene = formats::import_scene(folder / "a.gltf", options);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

std::vector<vec3> positions_of(const Scene& scene, double time_s = 0) {
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, time_s, frame);
  return frame.positions;
}

TEST(PlaceScene, GivesEqualScenesTheSameBitsWhereverTheyStand) {
  const Scene near = import(far_scene({0, 0, 0}));
  EXPECT_EQ(near.frame.origin, dvec3(0));
  for (const double far : {1e3, 1e6, 1e7, 5334567.0}) {
    const Scene scene = import(far_scene({far, 0, -2 * far}));
    EXPECT_EQ(scene.frame.origin, dvec3(far, 0, -2 * far));
    EXPECT_EQ(positions_of(scene), positions_of(near));
    EXPECT_EQ(evaluate_camera(scene, -1, 0, 0, 64, 48).eye, evaluate_camera(near, -1, 0, 0, 64, 48).eye);
    EXPECT_EQ(evaluate_lights(scene, -1, 0)[0].position, evaluate_lights(near, -1, 0)[0].position);
  }
}

TEST(PlaceScene, SaysWhereVerticesAreFloatsTooFarApart) {
  const auto says = [](const GltfBuilder& file) {
    return testing::contains(import(file).warnings, "floats, which lie 0.5 m apart at 5334577 m");
  };
  GltfBuilder far;
  far.root["meshes"] = {
      {{"primitives",
        {{{"attributes",
           {{"POSITION", far.floats({5334567, 0, 0, 5334577, 0, 0, 5334567, 10, 0}, "VEC3", 3, true)}}}}}}}};
  far.root["nodes"] = {{{"mesh", 0}}};
  EXPECT_TRUE(says(far));
  far.root["nodes"] = {{{"mesh", 0}, {"translation", {-5334567, 0, 0}}}};
  EXPECT_FALSE(says(far)) << "the node brings it back";
  EXPECT_TRUE(import(far_scene({5334567, 0, 0})).warnings.empty()) << "the node carries it";
}

TEST(PlaceScene, SubtractsFromAMatrixAndFromVertices) {
  GltfBuilder sheared = far_scene({0, 0, 0});  // which is no product of translation, rotation and scale
  const auto with_matrix = [&](double far) {
    sheared.root["nodes"][0].erase("translation");
    sheared.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, far, 0, 0, 1};
    return import(sheared);
  };
  EXPECT_EQ(positions_of(with_matrix(1e6)), positions_of(with_matrix(0)));
  GltfBuilder vertices;  // a float holds 1000000.25
  const std::size_t positions =
      vertices.floats({1e6f, 0, 0, 1000001.25f, 0, 0, 1e6f, 0.75f, 0}, "VEC3", 3, true);
  vertices.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
  vertices.root["nodes"] = {{{"mesh", 0}}};
  EXPECT_EQ(positions_of(import(vertices)), (std::vector<vec3>{{0, 0, 0}, {1.25f, 0, 0}, {0, 0.75f, 0}}));
}

/// The root moves from `place` to 4 m beside it.
GltfBuilder moving_scene(const dvec3& place, bool cubic) {
  GltfBuilder file = far_scene(place);
  const auto x = static_cast<float>(place.x), z = static_cast<float>(place.z);
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1, true);
  const std::size_t values =
      cubic ? file.floats({9, 9, 9, x, 0, z, 1, 2, 3, 4, 5, 6, x + 4, 0, z, 9, 9, 9}, "VEC3", 3)
            : file.floats({x, 0, z, x + 4, 0, z}, "VEC3", 3);
  file.root["animations"] = {
      {{"samplers",
        {{{"input", times}, {"output", values}, {"interpolation", cubic ? "CUBICSPLINE" : "LINEAR"}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  return file;
}

TEST(PlaceScene, SubtractsFromTheKeysOfRoots) {
  for (const bool cubic : {false, true}) {
    const Scene near = import(moving_scene({0, 0, 0}, cubic)),
                far = import(moving_scene({1e6, 0, -2e6}, cubic));
    EXPECT_EQ(far.frame.origin, dvec3(1e6, 0, -2e6));
    for (const double time : {0.0, 0.3, 1.0}) EXPECT_EQ(positions_of(far, time), positions_of(near, time));
  }
}

TEST(PlaceScene, LeavesATrackToWhoElseUsesIt) {
  GltfBuilder file = moving_scene({1e6, 0, 0}, false);
  file.root["nodes"].push_back({{"name", "other"}});
  file.root["nodes"][1]["children"] = {2};
  file.root["animations"][0]["channels"].push_back(
      {{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}});
  const Scene scene = import(file);
  FrameGeometry frame;
  evaluate_frame(scene, 0, 0, frame);
  EXPECT_EQ(frame.pose.nodes[0].translation, dvec3(0));
  EXPECT_EQ(frame.pose.nodes[2].translation, dvec3(1e6, 0, 0));
}

TEST(PlaceScene, TurnsAndScales) {
  const Scene plain = import(far_scene({0, 0, 0})),
              turned = import(far_scene({0, 0, 0}), {.up = UpAxis::z, .metres_per_unit = 0.5});
  const std::vector<vec3> from = positions_of(plain), to = positions_of(turned);
  ASSERT_EQ(to.size(), from.size());
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_EQ(to[i], 0.5f * vec3(from[i].x, from[i].z, -from[i].y));
  EXPECT_EQ(turned.frame.up, UpAxis::z);
}

TEST(PlaceScene, SaysWhichUnitWouldHelp) {
  GltfBuilder file = far_scene({0, 0, 0});
  file.root["nodes"][0]["scale"] = {40000, 40000, 40000};
  const auto says = [](const Scene& scene) {
    return !scene.warnings.empty() && scene.warnings[0].find("(--unit mm where") != std::string::npos;
  };
  EXPECT_TRUE(says(import(file)));
  EXPECT_FALSE(says(import(file, {.metres_per_unit = 0.001})));
}

/// Keys of `path` at time 0.
double keyed(const Scene& scene, ChannelPath path) {
  for (const Channel& channel : scene.clips[0].channels)
    if (channel.path == path) return scene.clips[0].tracks[static_cast<std::size_t>(channel.track)].values[0];
  return 0;
}

TEST(PlaceScene, ScalesKeysThatNoNodeScales) {
  Scene scene;
  scene.lights = {{.type = LightType::spot, .intensity = 64, .range_m = 8.0f},
                  {.type = LightType::directional}};
  scene.cameras.emplace_back();
  scene.nodes = {{.light = 0, .camera = 0}, {.light = 1}};
  Clip& clip = scene.clips.emplace_back();
  clip.tracks = {{.components = 1, .times_s = {0}, .values = {16}}};  // of all channels
  for (const auto& [node, path] : {std::pair(0, ChannelPath::light_intensity),
                                   {0, ChannelPath::light_range},
                                   {0, ChannelPath::camera_near},
                                   {0, ChannelPath::camera_extent},
                                   {0, ChannelPath::camera_fov}})
    clip.channels.push_back({.node = node, .path = path, .track = 0});
  clip.channels.push_back({.node = 1, .path = ChannelPath::light_intensity, .track = 0});
  formats::place_scene({.metres_per_unit = 0.25}, scene);
  EXPECT_EQ(scene.lights[0].intensity, 4);
  EXPECT_EQ(scene.lights[0].range_m, 2.0f);
  EXPECT_EQ(scene.lights[1].intensity, 1);
  EXPECT_EQ(keyed(scene, ChannelPath::light_intensity), 1);
  for (const ChannelPath path :
       {ChannelPath::light_range, ChannelPath::camera_near, ChannelPath::camera_extent})
    EXPECT_EQ(keyed(scene, path), 4);
  EXPECT_EQ(keyed(scene, ChannelPath::camera_fov), 16);
  EXPECT_EQ(scene.clips[0].channels.back().track, 0) << "lux is the same in every unit";
}

TEST(PlaceScene, ExportWritesTheFilesCoordinates) {
  const dvec3 place(691234, 0, 5334567.25);
  const Scene far = import(far_scene(place));
  ASSERT_EQ(far.frame.origin, dvec3(691234, 0, 5334567));
  const TemporaryFolder folder;
  const auto losses = formats::export_glb(far, folder / "a.glb");
  ASSERT_TRUE(losses) << losses.error().message;
  EXPECT_TRUE(losses->empty());
  formats::ImportOptions options;
  options.placement.offset = OffsetChoice::none;
  const Scene back = formats::import_scene(folder / "a.glb", options).value();
  scene::each_unrounded(back, -1, 0, [&](std::size_t v, const dvec3& at) {
    const dvec3 in_file = far.frame.to_file(dvec3(positions_of(far)[v]));
    EXPECT_LT(glm::distance(at, in_file), 1e-6);
  });
  EXPECT_EQ(positions_of(formats::import_scene(folder / "a.glb").value()), positions_of(far));
}

}  // namespace
}  // namespace tenebra
