// Shafts on frames of the bundled and the BART scenes: nothing that blocks is left out, and little else is
// kept.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "soft/shaft_check.h"
#include "soft/soft_frames.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

/// On scenes with point lights: a square of 4 % of the soup's diagonal around `centre`, facing the soup's
/// middle.
AreaLight light_of_4_percent(const Soup& soup, glm::vec3 centre) {
  const dvec3 low = soup.low(), high = soup.high();
  return square_light(dvec3(centre), 0.5 * (low + high), 0.04 * glm::length(high - low));
}

GroupCase group_case(const SceneFrame& frame, int width, int height) {
  GroupCase c;
  c.name = fmt::format("{} {}", frame.scene, frame.frame);
  LoadedFrame loaded = load_frame(frame, width, height);
  c.soup = std::move(loaded.soup), c.view = loaded.view, c.points = std::move(loaded.points);
  const WorldLight light = evaluate_lights(loaded.scene, 0, loaded.time_s).at(0);
  c.light = loaded.scene.lights[static_cast<std::size_t>(light.light)].type == LightType::area_rect
                ? *make_rectangle_light(light.position, -light.axis_x, light.axis_y)
                : light_of_4_percent(c.soup, light.position);
  return c;
}

void expect_no_blocker_left_out(const SceneFrame& frame) {
  const GroupCase c = group_case(frame, 320, 180);
  ShaftCheck check(c);
  Tally tally;
  check.run(tally, 30, 3);
  tally.print(c.name.c_str());
  EXPECT_GT(tally.blocked, 500u) << c.name;
  EXPECT_GT(tally.dropped, 50 * tally.kept) << c.name;
}

TEST(ShaftFrames, NeverLeaveOutATriangleThatBlocksInBundledScenes) {
  for (const SceneFrame& frame : bundled_frames) expect_no_blocker_left_out(frame);
}

TEST(ShaftFrames, NeverLeaveOutATriangleThatBlocksInBart) {
  for (const SceneFrame& frame : bart_frames) expect_no_blocker_left_out(frame);
}

}  // namespace
}  // namespace tenebra::testing
