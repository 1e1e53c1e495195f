// Shafts on frames of the bundled and the BART scenes: nothing that blocks is left out, and little else is
// kept.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "formats/import_scene.h"
#include "soft/shaft_check.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

struct SceneFrame {
  const char* scene;  ///< below scenes/bart, or a bundled one
  int frame;
  const char* no_cast = "";
};

std::filesystem::path path_of(const SceneFrame& frame) {
  const std::filesystem::path bundled = std::filesystem::path(TENEBRA_SCENES_DIR) / frame.scene;
  return std::filesystem::exists(bundled)
             ? bundled
             : std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes/bart" / frame.scene;
}

/// On scenes with point lights: a square of 4 % of the soup's diagonal around `centre`, facing the soup's
/// middle.
AreaLight square_light(const Soup& soup, glm::vec3 centre) {
  const dvec3 to_middle = glm::normalize(0.5 * (soup.low() + soup.high()) - dvec3(centre));
  const dvec3 other = std::abs(to_middle.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(other, to_middle)), y = glm::cross(to_middle, x);
  const double half = 0.02 * glm::length(soup.high() - soup.low());
  const Expected<AreaLight> light = make_rectangle_light(centre, glm::vec3(half * x), glm::vec3(half * y));
  EXPECT_TRUE(light) << light.error().message;
  return light ? *light : AreaLight{};
}

GroupCase frame_case(const SceneFrame& frame, int width, int height) {
  GroupCase c;
  c.name = fmt::format("{} {}", frame.scene, frame.frame);
  Expected<Scene> scene = formats::import_scene(path_of(frame));
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return c;
  }
  std::string unmatched;
  if (*frame.no_cast != 0 && !leave_out_casters(*scene, {frame.no_cast}, unmatched))
    ADD_FAILURE() << unmatched << " matches nothing in " << frame.scene;
  const double time_s = frame_time_s(scene->clips.at(0), frame.frame, 30.0);
  FrameGeometry geometry;
  evaluate_frame(*scene, 0, time_s, geometry);
  c.soup.positions = geometry.positions, c.soup.triangles = geometry.triangles;
  c.soup.casts = geometry.casts_shadow;
  c.view = evaluate_camera(*scene, 0, time_s, 0, width, height);
  c.points = view_samples(c.soup.view(), c.view, width, height);
  const WorldLight light = evaluate_lights(*scene, 0, time_s).at(0);
  c.light = scene->lights[static_cast<std::size_t>(light.light)].type == LightType::area_rect
                ? *make_rectangle_light(light.position, -light.axis_x, light.axis_y)
                : square_light(c.soup, light.position);
  return c;
}

void expect_no_blocker_left_out(const SceneFrame& frame) {
  const GroupCase c = frame_case(frame, 320, 180);
  if (::testing::Test::HasFailure()) return;
  ShaftCheck check(c);
  Tally tally;
  check.run(tally, 30, 3);
  tally.print(c.name.c_str());
  EXPECT_GT(tally.blocked, 500u) << c.name;
  EXPECT_GT(tally.dropped, 50 * tally.kept) << c.name;
}

TEST(ShaftFrames, NeverLeaveOutATriangleThatBlocksInBundledScenes) {
  for (const SceneFrame& frame :
       {SceneFrame{"city.glb", 150}, SceneFrame{"gallery.glb", 100}, SceneFrame{"court.glb", 150}})
    expect_no_blocker_left_out(frame);
}

TEST(ShaftFrames, NeverLeaveOutATriangleThatBlocksInBart) {
  if (!std::filesystem::exists(path_of({"robots/Robot.aff", 0})))
    GTEST_SKIP() << "The BART scenes are not at " TENEBRA_SHARED_DIR ".";
  for (const SceneFrame& frame :
       {SceneFrame{"robots/Robot.aff", 100, "city2.aff:69"}, SceneFrame{"museum/museum5.aff", 20},
        SceneFrame{"kitchen/kitchen.aff", 100}})
    expect_no_blocker_left_out(frame);
}

}  // namespace
}  // namespace tenebra::testing
