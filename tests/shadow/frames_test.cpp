// The mask is the exact answer on frames of the bundled and the BART scenes; and where Embree says otherwise,
// Embree is wrong.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>

#include "formats/import_scene.h"
#include "shadow/mask_case.h"
#include "stage/left_out.h"
#include "support/bart.h"

namespace tenebra::testing {
namespace {

struct SceneFrame {
  const char* scene;  ///< of BART, or a bundled one
  int frame;
  const char* no_cast = "";
};
const SceneFrame bart_frames[] = {{"robots/Robot.aff", 100, "city2.aff:69"},
                                  {"robots/Robot.aff", 160, "city2.aff:69"},
                                  {"robots/Robot.aff", 400, "city2.aff:69"},
                                  {"robots/Robot.aff", 640, "city2.aff:69"},
                                  {"museum/museum5.aff", 20},
                                  {"museum/museum5.aff", 100},
                                  {"museum/museum5.aff", 200},
                                  {"kitchen/kitchen.aff", 100},
                                  {"kitchen/kitchen.aff", 400}};

const SceneFrame bundled_frames[] = {{"city.glb", 0},    {"city.glb", 150},    {"city.glb", 300},
                                     {"gallery.glb", 0}, {"gallery.glb", 100}, {"gallery.glb", 200},
                                     {"court.glb", 0},   {"court.glb", 150}};

std::filesystem::path path_of(const SceneFrame& frame) {
  const std::filesystem::path bundled = std::filesystem::path(TENEBRA_SCENES_DIR) / frame.scene;
  return std::filesystem::exists(bundled) ? bundled : bart_folder() / frame.scene;
}

/// One case a light; points of the frame's own camera.
std::vector<MaskCase> frame_cases(const SceneFrame& frame, int width, int height) {
  std::vector<MaskCase> cases;
  Expected<Scene> scene = formats::import_scene(path_of(frame));
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return cases;
  }
  std::string unmatched;
  if (*frame.no_cast != 0 && !stage::leave_out_casters(*scene, {frame.no_cast}, unmatched)) {
    ADD_FAILURE() << unmatched << " matches nothing in " << frame.scene;
  }
  const double time_s = frame_time_s(scene->clips.at(0), frame.frame, 30.0);
  FrameGeometry geometry;
  evaluate_frame(*scene, 0, time_s, geometry);
  MaskCase c;
  c.soup.positions = geometry.positions, c.soup.triangles = geometry.triangles,
  c.soup.casts = geometry.casts_shadow;
  c.view = evaluate_camera(*scene, 0, time_s, 0, width, height);
  c.points = view_samples(c.soup.view(), c.view, width, height);
  for (const WorldLight& light : evaluate_lights(*scene, 0, time_s)) {
    c.name = fmt::format("{} frame {} light {}", frame.scene, frame.frame, light.light);
    c.light = point_light(light.position);
    if (scene->lights[static_cast<std::size_t>(light.light)].type == LightType::directional) {
      c.light = {.directional = true, .to_light = -light.direction};
    }
    cases.push_back(c);
  }
  return cases;
}

/// Every light of every frame, the variants in turn; returns the number of samples.
std::uint64_t expect_exact(std::span<const SceneFrame> frames, int size) {
  std::uint64_t samples = 0;
  int turn = 0;
  for (const SceneFrame& frame : frames) {
    Shares own;
    for (MaskCase& c : frame_cases(frame, size, size)) {
      c.config.variant = all_variants[turn++ % std::size(all_variants)];
      EXPECT_TRUE(exact(c, &own));
    }
    own.print(fmt::format("{} {}", frame.scene, frame.frame).c_str());
    // A handful of pairs a frame need more than floats.
    EXPECT_LE(static_cast<double>(own.float_unknown), 1e-5 * static_cast<double>(own.leaf_tests) + 20)
        << frame.scene << " " << frame.frame;
    samples += own.samples;
  }
  return samples;
}

TEST(Bart, MasksAreExact) {
  EXPECT_GE(expect_exact(bart_frames, 256), 200000u);
}

TEST(BundledScenes, MasksAreExact) {
  EXPECT_GE(expect_exact(bundled_frames, 192), 200000u);
}

TEST(Bart, MasksAreTheSameForAllVariantsThreadsAndOrders) {
  for (const SceneFrame& frame : {bart_frames[1], bart_frames[5], bart_frames[8]}) {
    std::vector<MaskCase> cases = frame_cases(frame, 128, 128);
    ASSERT_FALSE(cases.empty());
    MaskCase& c = cases.front();
    const ShadowMask expected = oracle(c);
    for (const int threads : {1, 3, 64})
      with_threads(threads, [&] { EXPECT_TRUE(all_variants_give(c, expected)) << threads << " threads"; });
    Random random(9);
    std::vector<std::uint32_t> place(c.soup.triangles.size());
    for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
    for (std::uint32_t i = static_cast<std::uint32_t>(place.size()); i > 1; --i)
      std::swap(place[i - 1], place[random.index(i)]);
    MaskCase shuffled = c;
    for (std::uint32_t i = 0; i < place.size(); ++i) {
      shuffled.soup.triangles[place[i]] = c.soup.triangles[i];
      shuffled.soup.casts[place[i]] = c.soup.casts[i];
    }
    for (std::uint32_t& id : shuffled.points.triangles)
      if (id != no_triangle) id = place[id];
    EXPECT_TRUE(all_variants_give(shuffled, expected)) << "shuffled, seed 9";
  }
}

/// Shadow rays of the peer, from float points, the usual way: the own triangle is left by a distance of 1e-4.
void compare_with_peer(const MaskCase& c) {
  const PeerTracer peer(c.soup.view());
  const ShadowMask mask = traced(c);
  const oracle::ExactShadow judge(c.view, c.soup.view(), c.light, c.config);
  std::size_t differing = 0, ours_wrong = 0, active = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const glm::dvec3 p = c.points.positions[i];
    const std::uint32_t id = c.points.triangles[i];
    if (!judge.active(p, id)) continue;
    ++active;
    const glm::vec3 from(p), to_light(glm::dvec3(c.light.position) - p);
    if (peer.occluded(from, to_light, 1e-4f, 1.0f) == (mask[i] == 0)) continue;
    ++differing;
    oracle::ExactMaskStats stats;
    ours_wrong += (judge.blocker(p, id, stats) != no_triangle) != (mask[i] == 0);
  }
  std::printf(
      "%s: Embree differs in %zu of %zu active pixels; exact arithmetic finds us wrong in %zu, Embree in "
      "%zu\n",
      c.name.c_str(), differing, active, ours_wrong, differing - ours_wrong);
  EXPECT_EQ(ours_wrong, 0u) << c.name;
  EXPECT_LT(differing, active / 20) << "the comparison itself is broken";
}

TEST(Bart, WhereEmbreeDiffersEmbreeIsWrong) {
  // The peer lets every triangle cast, so a frame where all do.
  std::vector<MaskCase> cases = frame_cases(bart_frames[7], 1024, 1024);
  ASSERT_FALSE(cases.empty());
  compare_with_peer(cases.front());
}

TEST(ShadowMaskPeer, WhereEmbreeDiffersOnARoomEmbreeIsWrong) {
  Random random(11);
  MaskCase c;
  c.name = "room, seed 11";
  c.soup = room(random, 4000);
  c.light = point_light({0.3, 1.7, -0.4});
  c.view = pinhole({-1.8, 1.5, -1.7}, {0, 0, 0}, 0.9, 1024, 1024);
  c.points = view_samples(c.soup.view(), c.view, 1024, 1024);
  compare_with_peer(c);
}

}  // namespace
}  // namespace tenebra::testing
