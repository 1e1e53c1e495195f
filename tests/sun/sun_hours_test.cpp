// Hours against closed forms and rational arithmetic; and that nothing but the question decides them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <tenebra/threads.h>
#include "reference/rational_mask.h"
#include "sun/hours_table.h"
#include "sun_scenes.h"
#include "support/seeded_random.h"

namespace tenebra::sun {
namespace {

using testing::day_of_suns, testing::frame_of, testing::geometry_of, testing::hours_at, testing::wall_scene;

constexpr const char* equinox = "2026-03-20";

// At the equinox the sun goes round in a plane through east and west that is 90 - latitude high in the south:
// behind a long wall of 2 m, shadow ends 2 m * tan(latitude) north of it, all day. Its declination changes by
// 0.2 degrees on that day, which moves the end by 1.3 cm. East and west the wall ends, 20 m away: some
// minutes after sunrise.
TEST(SunHours, ShadowOfAWallAtTheEquinox) {
  const double end = 2 * std::tan(glm::radians(48.0));
  const SunHours hours =
      hours_at(wall_scene(), {{0, -1, 0}, {0, 0.5 * end, 0}, {0, end - 0.02, 0}, {0, end + 0.02, 0}},
               day_of_suns(48, equinox, 1));
  const double step = 2, ends_of_wall = 60;
  EXPECT_NEAR(hours.sums[0], 720, step);
  EXPECT_LT(hours.sums[1], ends_of_wall);
  EXPECT_LT(hours.sums[2], 3 * ends_of_wall);
  EXPECT_GT(hours.sums[3], 720 - 3 * ends_of_wall);
}

// Faces see half of the day at the equinox where they look east or west, all of it south, and nothing north.
TEST(SunHours, FacesOfATower) {
  const Scene tower = testing::map_scene(
      {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 9}, {9, 0, 9}, {9, 9, 9}, {0, 9, 9}},
      "f 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");  // top, south, east, north, west
  const FrameGeometry frame = frame_of(tower);
  const Suns suns = day_of_suns(48, equinox, 10);
  const SunHours hours =
      sun_hours(geometry_of(frame), face_receivers(tower, frame, {}).value(), suns, {}).value();
  const double expected[] = {720, 720, 360, 0, 360};
  for (std::size_t side = 0; side < 5; ++side) {
    EXPECT_NEAR(hours.sums[2 * side], expected[side], 20) << side;
    EXPECT_EQ(hours.sums[2 * side], hours.sums[2 * side + 1]);
  }
  EXPECT_LT(suns.list[static_cast<std::size_t>(hours.last[4])].utc_s,
            suns.list[static_cast<std::size_t>(hours.first[8])].utc_s + 1200);
  EXPECT_LT(hours.first[6], 0);
}

// The minutes of each point are those of the suns that rational arithmetic sees.
TEST(SunHours, AreThoseOfRationalArithmetic) {
  testing::Random random(55);
  const auto between = [&](double low, double high) { return static_cast<float>(random.in(low, high)); };
  FrameGeometry frame;
  frame.positions = {{-9, 0, 9}, {9, 0, 9}, {0, 0, -9}};
  for (int i = 0; i < 36; ++i) frame.positions.emplace_back(between(-8, 8), between(0.1, 4), between(-8, 8));
  for (std::uint32_t i = 0; i < 39; i += 3) frame.triangles.emplace_back(i, i + 1, i + 2);
  const TriangleView triangles{.positions = frame.positions, .triangles = frame.triangles};
  const ViewRays view{.eye = {0, 100, 0}};
  VisiblePoints points{.width = 6, .height = 2};
  for (int i = 0; i < 12; ++i) points.positions.emplace_back(between(-2, 2), 0, between(-2, 2));
  points.triangles.assign(12, 0), points.sides.assign(12, 1);
  const Suns suns = day_of_suns(48, "2026-05-01", 30);
  std::vector<double> expected(12);
  for (const Sun& sun : suns.list) {
    const auto mask = reference::rational_mask(points, view, triangles,
                                               {.directional = true, .to_light = glm::vec3(sun.to_sun)}, {});
    for (std::size_t i = 0; i < 12; ++i) expected[i] += mask[i] == 255 ? sun.weight : 0;
  }
  const std::vector<std::uint32_t> ends{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const QueryPoints asked{
      .positions = points.positions, .triangles = points.triangles, .sides = points.sides};
  const auto hours =
      sun_hours(Geometry::create(frame.positions, frame.triangles).value(), asked, ends, suns.list, {});
  EXPECT_EQ(hours.value().sums, expected);
  EXPECT_NE(*std::min_element(expected.begin(), expected.end()),
            *std::max_element(expected.begin(), expected.end()));
}

TEST(SunHours, MapCoordinatesChangeNoByte) {
  const glm::dvec3 shift(690000, 5330000, 500);
  const Suns suns = day_of_suns(48, "2026-06-21");
  const auto study = [&](const Scene& scene) {
    const FrameGeometry frame = frame_of(scene);
    const Receivers faces = face_receivers(scene, frame, {}).value();
    const SunHours hours = sun_hours(geometry_of(frame), faces, suns, {}).value();
    return std::pair(hours, csv_of({scene, frame, faces, suns, hours}));
  };
  const auto near = study(wall_scene()), far = study(wall_scene(shift));
  EXPECT_EQ(near.first.sums, far.first.sums);
  EXPECT_EQ(near.first.first, far.first.first);
  EXPECT_NE(far.second.find("\n0,"), std::string::npos);
  EXPECT_NE(far.second.find(",690006.666667,"), std::string::npos) << far.second;  // the floor's first middle
}

TEST(SunHours, ThreadsChangeNoByte) {
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  const Receivers faces = ground_receivers(frame, scene.frame, 0.5, 0.5).value();
  ASSERT_GT(faces.positions.size(), 4096u) << "enough for several threads";
  for (const double disc : {0.0, 0.53}) {
    std::vector<SunHours> hours;
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        hours.push_back(sun_hours(geometry_of(frame), faces, day_of_suns(48, "2026-06-21", 60),
                                  {.disc_deg = disc, .months = true})
                            .value());
      });
    EXPECT_EQ(hours[0].sums, hours[1].sums);
    EXPECT_EQ(hours[0].months, hours[1].months);
    EXPECT_EQ(hours[0].first, hours[1].first);
    EXPECT_EQ(hours[0].last, hours[1].last);
    EXPECT_EQ(hours[0].months[5], hours[0].sums[0]);  // June
  }
}

// A disc that the edge of a long wall halves counts half.
TEST(SunHours, OfADiscTheVisibleShareCounts) {
  const Scene scene =
      testing::map_scene({{-1e4, 1, -1}, {1e4, 1, -1}, {1e4, 1, 1}, {-1e4, 1, 1}}, "f 1 2 3 4\n");
  Suns suns;
  suns.list.push_back({glm::normalize(glm::dvec3(0, 1, -1)), 60});  // in the north, 45 degrees high
  const SunHours hours = hours_at(scene, {{0, 0, 0}, {0, 0.002, 0}, {0, -0.1, 0}}, suns, {.disc_deg = 0.53});
  EXPECT_NEAR(hours.sums[0], 30, 0.1);
  EXPECT_LT(hours.sums[1], 30);
  EXPECT_EQ(hours.sums[2], 60);
}

TEST(SunHours, StopsAndSaysHowFarItIs) {
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  const Receivers faces = face_receivers(scene, frame, {}).value();
  const Suns suns = day_of_suns(48, equinox);
  StopFlag stop;
  double part = 0;
  const auto halfway = [&](double done) {
    if ((part = done) > 0.5) stop.request();
  };
  EXPECT_TRUE(is_stop(sun_hours(geometry_of(frame), faces, suns, {}, &stop, halfway)));
  EXPECT_LT(part, 0.55);
}

TEST(SunHours, Tables) {
  Scene scene = wall_scene();
  scene.nodes.back().name = "a \"b\", c";
  const FrameGeometry frame = frame_of(scene);
  const Receivers faces = face_receivers(scene, frame, {.per_face = 1}).value();
  const Suns night = day_of_suns(80, "2026-12-21");
  const SunHours none = sun_hours(geometry_of(frame), faces, night, {}).value();
  const std::string csv = csv_of({scene, frame, faces, night, none});
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "face,node,material,x,y,z,area_m2,hours,first_sun,last_sun");
  EXPECT_NE(csv.find(",800,0,,\n"), std::string::npos) << csv;
  EXPECT_NE(json_of({scene, frame, faces, night, none}).find(", 800, 0, null, null]"), std::string::npos);
}

}  // namespace
}  // namespace tenebra::sun
