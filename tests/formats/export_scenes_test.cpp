// export_glb on whole scenes, BART's and the bundled ones: a second reader accepts the file, and ours finds
// the same triangles at frames and between them. Then what glTF has no words for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <tenebra/frame_geometry.h>
#include "round_trip.h"
#include "support/bart.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using testing::round_trip;
using testing::RoundTrip;

/// Corners of all triangles, sorted on each axis: the same whatever the order of the triangles.
std::array<std::vector<float>, 3> corners(const Scene& scene, double time_s) {
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, time_s, frame);
  EXPECT_EQ(frame.dropped_non_finite, 0u);
  std::array<std::vector<float>, 3> values;
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& t : frame.triangles)
      for (int c = 0; c < 3; ++c) values[axis].push_back(frame.positions[t[c]][axis]);
    std::sort(values[axis].begin(), values[axis].end());
  }
  return values;
}

/// Largest distance between corners of the two scenes, as a share of the size of `a`.
double difference(const Scene& a, const Scene& b, double time_a, double time_b) {
  const auto va = corners(a, time_a), vb = corners(b, time_b);
  double most = 0, extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(va[axis].size(), vb[axis].size());
    if (va[axis].size() != vb[axis].size()) return INFINITY;
    extent = std::max(extent, double{va[axis].back()} - va[axis].front());
    for (std::size_t i = 0; i < va[axis].size(); ++i)
      most = std::max(most, std::abs(double{va[axis][i]} - vb[axis][i]));
  }
  return most / extent;
}

struct Exported {
  const char* file;
  double
      between;    ///< allowed between frames, a share of the scene's size: chords of arcs of a frame's length
  double clip_s;  ///< length of the clip
};

void PrintTo(const Exported& exported, std::ostream* out) {
  *out << exported.file;
}

class ExportScenes : public ::testing::TestWithParam<Exported> {
protected:
  static fs::path path() {
    const fs::path inside = fs::path(TENEBRA_SCENES_DIR) / GetParam().file;
    return fs::exists(inside) ? inside : testing::bart_folder() / GetParam().file;
  }
};

TEST_P(ExportScenes, ComeBackWhole) {
  const auto scene = formats::import_scene(path());
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  const testing::TemporaryFolder folder;
  const auto losses = formats::export_glb(*scene, folder / "out.glb");
  ASSERT_TRUE(losses.has_value()) << losses.error().message;

  const testing::SecondReader reader(testing::read_text(folder / "out.glb"));
  reader.check();
  FrameGeometry frame;
  evaluate_frame(*scene, -1, 0, frame);
  EXPECT_EQ(reader.triangles(), frame.triangles.size());
  EXPECT_EQ(reader.root["nodes"].size(), scene->nodes.size());

  const auto back = formats::import_gltf(folder / "out.glb");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_TRUE(back->warnings.empty()) << back->warnings[0];
  ASSERT_EQ(back->clips.size(), 1u);
  const Clip &clip = scene->clips.at(0), &again = back->clips[0];
  EXPECT_NEAR(again.end_s - again.start_s, GetParam().clip_s, 1e-5);
  const double delay = std::max(0.0, -clip.start_s);
  const int frames = frame_count(clip, 30);
  for (const int i : {0, frames / 7, frames / 2, frames - 1}) {
    const double there = static_cast<float>(frame_time_s(clip, i, 30) + delay);
    EXPECT_LT(difference(*scene, *back, there - delay, there), 2e-6) << "frame " << i;
  }
  for (const int i : {frames / 7, frames / 2}) {
    const double time = (frame_time_s(clip, i, 30) + frame_time_s(clip, i + 1, 30)) / 2;
    EXPECT_LT(difference(*scene, *back, time, time + delay), GetParam().between) << "after frame " << i;
  }
  ASSERT_EQ(back->lights.size(), scene->lights.size());
  for (std::size_t i = 0; i < back->lights.size(); ++i) {
    EXPECT_EQ(back->lights[i].falloff, scene->lights[i].falloff);
    EXPECT_EQ(back->lights[i].intensity, scene->lights[i].intensity);
    EXPECT_EQ(back->lights[i].color, scene->lights[i].color);
  }
  ASSERT_GE(back->materials.size(), scene->materials.size());
  for (std::size_t i = 0; i < scene->materials.size(); ++i) {
    EXPECT_EQ(back->materials[i].ambient, scene->materials[i].ambient);
    EXPECT_EQ(back->materials[i].base_color, scene->materials[i].base_color);
  }
  EXPECT_EQ(back->ambient_light, scene->ambient_light);
  EXPECT_EQ(back->background, scene->background);
}

INSTANTIATE_TEST_SUITE_P(Whole, ExportScenes,
                         ::testing::Values(Exported{"robots/Robot.aff", 1e-4, 50},
                                           Exported{"kitchen/kitchen.aff", 1e-4, 20},
                                           Exported{"museum/museum5.aff", 1e-6, 6},
                                           Exported{"city.glb", 1e-6, 10}, Exported{"court.glb", 1e-6, 10},
                                           Exported{"gallery.glb", 1e-6, 12},
                                           Exported{"square.glb", 1e-6, 9.6}));

TEST(ExportSecondReader, AcceptsTheSharedGltfFiles) {
  const fs::path shared = fs::path(TENEBRA_SHARED_DIR) / "scenes/extra/gltf";
  // Models of others have licences of their own: they lie beside the checkout, not in it.
  if (!fs::exists(shared)) GTEST_SKIP() << "The scenes are not at " << shared << ".";
  const testing::TemporaryFolder folder;
  for (const char* name : {"BoxAnimated.glb", "CesiumMan.glb", "AnimatedMorphCube.glb", "Fox.glb",
                           "HotelRoom.glb", "khronos_blender_io_03_all_animations/03_all_animations.gltf"}) {
    SCOPED_TRACE(name);
    const auto scene = formats::import_gltf(shared / name);
    ASSERT_TRUE(scene.has_value());
    ASSERT_TRUE(formats::export_glb(*scene, folder / "out.glb").has_value());
    testing::SecondReader(testing::read_text(folder / "out.glb")).check();
  }
}

/// A triangle of one material under a node.
Scene small_scene() {
  Scene scene;
  scene.materials.resize(1);
  Mesh mesh;
  mesh.name = "triangle";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  scene.meshes.push_back(mesh);
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

void expect_loss(const RoundTrip& trip, const char* words) {
  ASSERT_EQ(trip.losses.size(), 1u);
  EXPECT_NE(trip.losses[0].find(words), std::string::npos) << trip.losses[0];
}

TEST(ExportLosses, AreNoneForAPlainScene) {
  EXPECT_TRUE(round_trip(small_scene()).losses.empty());
}

TEST(ExportLosses, HiddenNodesStayHiddenWithAllBelowThem) {
  Scene scene = small_scene();
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes[1].parent = 0;
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes[0].visible = false;
  const RoundTrip trip = round_trip(scene);
  expect_loss(trip, "2 hidden nodes");
  ASSERT_EQ(trip.back.nodes.size(), 3u);
  FrameGeometry frame;
  evaluate_frame(trip.back, -1, 0, frame);
  EXPECT_EQ(frame.triangles.size(), 1u);
}

TEST(ExportLosses, LightsWithoutFalloffAreAsBrightAtTheMiddle) {
  Scene scene = small_scene();
  scene.lights.resize(1);
  scene.lights[0].falloff = Falloff::none;
  scene.lights[0].intensity = 0.25f;
  scene.nodes.emplace_back();
  scene.nodes[1].light = 0;
  scene.nodes[1].translation = {0.5, 0.5, 10};
  const RoundTrip trip = round_trip(scene);
  expect_loss(trip, "fade");
  EXPECT_EQ(trip.back.lights[0].falloff, Falloff::none);
  EXPECT_EQ(trip.back.lights[0].intensity, 0.25f);
  // Lambert's 1 / pi and the square of 10 m undo each other at the middle.
  const double candela = trip.root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"];
  EXPECT_NEAR(candela / (10 * 10) / 3.14159265358979, 0.25, 1e-6);
}

TEST(ExportLights, SunsKeepTheirDiameter) {
  Scene scene = small_scene();
  scene.lights = {{.name = "sun", .type = LightType::directional, .diameter_deg = 0.53f},
                  {.name = "edge", .type = LightType::directional}};
  for (int i = 0; i < 2; ++i) scene.nodes.push_back({.light = i});
  const RoundTrip trip = round_trip(scene);
  EXPECT_EQ(trip.back.lights[0].diameter_deg, 0.53f);
  EXPECT_EQ(trip.back.lights[1].diameter_deg, 0.0f);
  EXPECT_FALSE(trip.root["extensions"]["KHR_lights_punctual"]["lights"][1].contains("extras"));
}

TEST(ExportLosses, MatricesThatShearAreNamed) {
  Scene scene = small_scene();
  scene.nodes[0].matrix = glm::dmat4(1);
  (*scene.nodes[0].matrix)[1][0] = 1;
  const RoundTrip trip = round_trip(scene);
  expect_loss(trip, "nodes[0]");
  EXPECT_LT(difference(scene, trip.back, 0, 0), 1e-7);
}

TEST(ExportLosses, VisibilityOfAMatrixNodeIsNamed) {
  Scene scene = small_scene();
  scene.nodes[0].matrix = glm::dmat4(1);
  (*scene.nodes[0].matrix)[1][0] = 1;
  Clip clip;
  clip.end_s = 1;
  clip.tracks.push_back({Interpolation::step, 1, {0, 0.5}, {1, 0}, {}});
  clip.channels.push_back({0, ChannelPath::visibility, 0});
  scene.clips.push_back(clip);
  const RoundTrip trip = round_trip(scene);
  ASSERT_EQ(trip.losses.size(), 2u);
  EXPECT_NE(trip.losses[1].find("always shown"), std::string::npos) << trip.losses[1];
}

TEST(ExportLosses, VisibilityBecomesScale) {
  Scene scene = small_scene();
  scene.nodes[0].visible = false;
  Clip clip;
  clip.end_s = 1;
  clip.frame_count = 11;
  clip.tracks.push_back({Interpolation::step, 1, {0, 0.5}, {0, 1}, {}});
  clip.channels.push_back({0, ChannelPath::visibility, 0});
  scene.clips.push_back(clip);
  const RoundTrip trip = round_trip(scene);
  EXPECT_TRUE(trip.losses.empty());
  const auto width = [&](double time_s) { return corners(trip.back, time_s)[0].back(); };
  EXPECT_EQ(width(0), 0);
  EXPECT_EQ(width(0.45), 0);
  EXPECT_EQ(width(0.55), 1);
}

TEST(ExportLosses, BrightMaterialsAreCutForOthersAndKeptForUs) {
  Scene scene = small_scene();
  scene.materials[0].base_color = {2, 0.5f, 0.25f};
  scene.materials[0].ambient = {3, 0, 0};
  const RoundTrip trip = round_trip(scene);
  expect_loss(trip, "1 materials");
  EXPECT_EQ(trip.back.materials[0].base_color, glm::vec3(2, 0.5f, 0.25f));
  EXPECT_EQ(trip.back.materials[0].ambient, glm::vec3(3, 0, 0));
  EXPECT_EQ(trip.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0], 1.0);
}

TEST(ExportLosses, AClipThatStartsBeforeZeroIsWrittenLater) {
  Scene scene = small_scene();
  Clip clip;
  clip.name = "early";
  clip.start_s = -2;
  clip.end_s = 1;
  clip.tracks.push_back({Interpolation::linear, 3, {-2, 1}, {0, 0, 0, 3, 0, 0}, {}});
  clip.channels.push_back({0, ChannelPath::translation, 0});
  scene.clips.push_back(clip);
  const RoundTrip trip = round_trip(scene);
  expect_loss(trip, "-2 s");
  EXPECT_LT(difference(scene, trip.back, -1, 1), 1e-7);
}

// Found by fuzzing: what was written could not be read.
TEST(ExportGlb, TheLargestFloatComesBackAndMoreIsRefused) {
  constexpr double largest = std::numeric_limits<float>::max();
  Scene scene = small_scene();
  scene.nodes[0].translation.y = -largest;
  EXPECT_EQ(round_trip(scene).back.nodes[0].translation.y, -largest);
  const testing::TemporaryFolder folder;
  for (const auto& [value, text] :
       {std::pair{4.3e116, "found 4.3e+116"}, std::pair{double{NAN}, "found nan"}}) {
    scene.nodes[0].translation.y = value;
    const auto written = formats::export_glb(scene, folder / "out.glb");
    ASSERT_FALSE(written.has_value());
    const std::string expected = std::string("/nodes/0/translation/1: ") + text;
    EXPECT_NE(written.error().message.find(expected), std::string::npos) << written.error().message;
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(ExportGlb, RefusesMoreFramesThanItCanBake) {
  Scene scene = small_scene();
  Clip clip;
  clip.end_s = 1;
  clip.frame_count = 2'000'000'000;
  clip.tracks.push_back({Interpolation::step, 1, {0, 0.5}, {0, 1}, {}});
  clip.channels.push_back({0, ChannelPath::visibility, 0});
  scene.clips.push_back(clip);
  const testing::TemporaryFolder folder;
  const auto written = formats::export_glb(scene, folder / "out.glb");
  ASSERT_FALSE(written.has_value());
  EXPECT_NE(written.error().message.find("2000000000 frames"), std::string::npos) << written.error().message;
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace tenebra
