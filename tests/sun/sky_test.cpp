// The light of a sky of patches: closed forms, and the sky of a weather file.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sun/hours_table.h"
#include "sun/sky.h"
#include "weather_files.h"

namespace tenebra::sun {
namespace {

using testing::frame_of, testing::wall_scene;

/// Light of a sky on a point of the file's coordinates.
double sky_at(const Scene& scene, const glm::dvec3& place, const glm::vec3& normal, int parts) {
  const FrameGeometry frame = frame_of(scene);
  Receivers point;
  point.kind = ReceiverKind::points;
  point.positions = {scene.frame.to_scene(place)};
  point.normals = {normal};
  point.list = {{1}};
  return sky_of({scene, frame, {}}, point, {}, sky_patches(parts, 7), {}).value().light[0];
}

const glm::vec3 up(0, 1, 0), south(0, 0, 1);

// The sum of the solid angles is 2 pi, and what the centres send onto a horizontal surface, with rows h high
// up to the height H, is pi (sin(H)^2 / cos(h / 2) + 2 (1 - sin(H))).
TEST(Sky, PatchesOfTregenzaAndReinhart) {
  const std::pair<int, std::size_t> counts[] = {{1, 145}, {2, 577}, {4, 2305}, {8, 9217}};
  for (const auto& [parts, count] : counts) {
    const std::vector<Sun> patches = sky_patches(parts, 0);
    ASSERT_EQ(patches.size(), count);
    double light = 0, horizontal = 0;
    for (const Sun& patch : patches)
      light += patch.light_wh_m2, horizontal += patch.light_wh_m2 * patch.to_sun.y;
    const double row = glm::radians(90 / (7 * parts + 0.5)), top = std::sin(7 * parts * row);
    EXPECT_NEAR(horizontal, 1, 1e-12);
    EXPECT_NEAR(light, 2 / (top * top / std::cos(row / 2) + 2 * (1 - top)), 1e-12);
  }
  EXPECT_EQ(parse_sky("tregenza").value(), 1);
  EXPECT_EQ(parse_sky("reinhart").value(), 2);
  EXPECT_EQ(parse_sky("reinhart:4").value(), 4);
  for (const char* text : {"", "perez", "reinhart:", "reinhart:1", "reinhart:9", "tregenza:2"})
    EXPECT_FALSE(parse_sky(text)) << text;
}

TEST(Sky, OpenHalfAndClosed) {
  EXPECT_NEAR(sky_at(wall_scene(), {0, -1, 9}, up, 1), 1, 1e-12);
  // A wall beside the point hides the half of each row, whose patches lie opposite each other in pairs; the
  // zenith's patch is seen.
  const Scene wall =
      testing::map_scene({{-1e5, 0, -1}, {1e5, 0, -1}, {1e5, 0, 1e5}, {-1e5, 0, 1e5}}, "f 1 2 3 4\n");
  for (const int parts : {1, 2})
    EXPECT_NEAR(sky_at(wall, {0, -0.1, 0}, up, parts), (1 + sky_patches(parts, 0).back().light_wh_m2) / 2,
                1e-12);
  const Scene box = testing::map_scene(
      {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 9}, {9, 0, 9}, {9, 9, 9}, {0, 9, 9}},
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  EXPECT_EQ(sky_at(box, {4, 4, 4}, up, 1), 0);
}

// An open wall gets the half of what the ground gets. The sum over a row's azimuths, each within d / 2 of its
// patch's centre, is off by less than (d / 2)^2 of it: 3 % for six patches in the row, less for others.
TEST(Sky, AnOpenWallGetsHalf) {
  EXPECT_NEAR(sky_at(wall_scene(), {0, 0, 90}, south, 1), 0.5, 0.01);
  EXPECT_NEAR(sky_at(wall_scene(), {0, 0, 90}, south, 4), 0.5, 0.001);
}

TEST(Sky, BothSidesOfAFaceTogether) {
  const Scene wall = testing::map_scene({{-9, 0, 0}, {9, 0, 0}, {9, 0, 9}}, "f 1 2 3\n");
  const FrameGeometry frame = frame_of(wall);
  for (const bool both : {false, true}) {
    const Receivers face = face_receivers(wall, frame, {.both_sides = both, .per_face = 1}).value();
    EXPECT_NEAR(sky_of({wall, frame, {}}, face, {}, sky_patches(4, 0), {}).value().light[0], both ? 1 : 0.5,
                0.002);
  }
}

TEST(Sky, OfAWeatherFile) {
  const auto weather = testing::weather_in(testing::epw_text(
      "48,0,0", {{2003, 6, 21, 1, 0, 5}, {2003, 6, 21, 13, 500, 100}, {2003, 7, 1, 13, 700, 200}}));
  const Suns suns = suns_of(*weather, {.days = parse_season("6:6").value()}).value();
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  const Receivers cell = ground_receivers(frame, scene.frame, 9, 40).value();
  const SkyLight sky = sky_of({scene, frame, {}}, cell, suns, sky_patches(1, 0), {}).value();
  EXPECT_NEAR(sky.light[0], 105, 1e-9) << "hours with the sun below the horizon too";
  const SunHours hours = hours_of({scene, frame, {}}, cell, suns, {}).value();
  const Study study{scene, frame, cell, suns, hours, &sky};
  EXPECT_EQ(value_of(study, 0), (hours.light[0] + sky.light[0]) / 1000);
  EXPECT_NE(csv_of(study).find("kwh_m2,sky_kwh_m2,hours,first_sun"), std::string::npos);
  EXPECT_NE(json_of(study).find("\"sky\": \"equally bright, 145 patches"), std::string::npos);
}

}  // namespace
}  // namespace tenebra::sun
