// Weather files: their suns, and their light on surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sun/hours_table.h"
#include "weather_files.h"

namespace tenebra::sun {
namespace {

using testing::epw_text, testing::frame_of, testing::geometry_of, testing::hours_at, testing::wall_scene,
    testing::weather_in;

double light_of(const Suns& suns) {
  return std::accumulate(suns.list.begin(), suns.list.end(), suns.lost_wh_m2,
                         [](double sum, const Sun& sun) { return sum + sun.light_wh_m2; });
}

TEST(Weather, HoursOfAFile) {
  const Weather weather =
      weather_in(epw_text("48.1,11.6,1.0", {{2003, 1, 1, 1, 5, 6}, {1999, 2, 28, 24, 9999, 7}})).value();
  EXPECT_EQ(weather.place.latitude_deg, 48.1);
  EXPECT_EQ(weather.place.longitude_deg, 11.6);
  EXPECT_EQ(weather.zone_min, 60);
  ASSERT_EQ(weather.hours.size(), 2u);
  EXPECT_EQ(time_text(weather.hours[0].begin_s, 0), "2003-01-01T00:00:00Z")
      << "hour 1 is that before 1 o'clock";
  EXPECT_EQ(weather.hours[0].direct_wh_m2, 5);
  EXPECT_EQ(time_text(weather.hours[1].begin_s, 0), "1999-02-28T23:00:00Z");
  EXPECT_EQ(weather.hours[1].direct_wh_m2, 0);
  EXPECT_EQ(weather.hours[1].diffuse_wh_m2, 7);
  EXPECT_EQ(weather.missing, 1u);
}

TEST(Weather, MayBeginWithAByteOrderMark) {
  const std::string text = "\xef\xbb\xbf" + epw_text("48,11,1", {{2003, 1, 1, 1, 5, 6}}) + "\n";
  EXPECT_EQ(weather_in(text).value().hours.size(), 1u);
}

TEST(Weather, LeapDays) {
  const Weather weather =
      weather_in(epw_text("0,0,-3.5", {{2004, 2, 29, 12, 1, 0}, {2003, 2, 29, 12, 1, 0}})).value();
  EXPECT_EQ(weather.zone_min, -210);
  EXPECT_EQ(time_text(weather.hours[0].begin_s, 0), "2004-02-29T11:00:00Z");
  EXPECT_EQ(time_text(weather.hours[1].begin_s, 0), "2003-03-01T11:00:00Z");
  const Suns suns = suns_of(weather, {}).value();
  for (const Sun& sun : suns.list) EXPECT_EQ(sun.month, 1) << "the file's month";
}

TEST(Weather, RefusesInASentence) {
  const auto refusal = [](const std::string& text) {
    const auto weather = weather_in(text);
    return weather ? "nothing" : weather.error().message;
  };
  const std::string whole = epw_text("48,11,1", {{2003, 1, 1, 1, 5, 6}});
  EXPECT_NE(refusal("").find("found no hour"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n").find("found no LOCATION"), std::string::npos);
  EXPECT_NE(refusal(epw_text("91,11,1", {})).find("w.epw:1: found 91 for the latitude"), std::string::npos);
  EXPECT_NE(refusal(epw_text("48,11,1", {}, 4)).find("w.epw:8: found 4 records in an hour"),
            std::string::npos);
  EXPECT_NE(refusal(epw_text("48,11,1", {})).find("found no hour"), std::string::npos);
  EXPECT_NE(refusal(whole + "2003,1,1,2\n").find("w.epw:10: found nothing for the direct"),
            std::string::npos);
  EXPECT_NE(refusal(epw_text("48,11,1", {{2003, 1, 1, 25, 5, 6}})).find("found 25 for the hour"),
            std::string::npos);
  EXPECT_NE(refusal(epw_text("48,11,1", {{2003, 4, 31, 1, 5, 6}})).find("found day 31 of month 4"),
            std::string::npos);
  EXPECT_NE(refusal(epw_text("48,11,1", {{2003, 1, 1, 1, -5, 6}})).find("found -5 for the direct"),
            std::string::npos);
}

// On 2003-06-21 the declination is 23.44 degrees and the sun 1.7 minutes late: at 48 N, 0 E its centre rises,
// without air, acos(-tan 48 tan 23.44) = 7.919 hours before 12:01.7, which is 4:06.6.
TEST(Weather, ASunStandsInTheMiddleOfWhatItIsUp) {
  const auto weather = weather_in(
      epw_text("48,0,0", {{2003, 6, 21, 4, 10, 0}, {2003, 6, 21, 5, 60, 0}, {2003, 6, 21, 13, 90, 0}}));
  const Suns suns = suns_of(*weather, {}).value();
  ASSERT_EQ(suns.list.size(), 2u);
  EXPECT_EQ(suns.lost_wh_m2, 10);
  EXPECT_EQ(suns.below, 1u);
  EXPECT_NEAR(suns.list[0].weight, 53.4, 1);
  EXPECT_EQ(suns.list[0].utc_s - suns.list[1].utc_s, -8 * 3600 + (60 - suns.list[0].weight) * 30);
  EXPECT_EQ(suns.list[1].weight, 60);
  const Suns fine = suns_of(*weather, {.step_min = 10}).value();
  ASSERT_EQ(fine.list.size(), 12u);
  EXPECT_NEAR(light_of(fine), 160, 1e-9);
  EXPECT_LT(fine.list[0].light_wh_m2, fine.list[1].light_wh_m2);
  EXPECT_EQ(fine.list[1].light_wh_m2, fine.list[2].light_wh_m2);
}

TEST(Weather, DaysByMonthAndDay) {
  const auto weather = weather_in(
      epw_text("0,0,0", {{2003, 1, 31, 12, 1, 0}, {1990, 2, 1, 12, 2, 0}, {1995, 12, 1, 12, 4, 0}}));
  const auto light = [&](const char* days) {
    return light_of(suns_of(*weather, {.days = parse_season(days).value()}).value());
  };
  EXPECT_EQ(light("1:12"), 7);
  EXPECT_EQ(light("02-01:11-30"), 2);
  EXPECT_EQ(light("12:1"), 5) << "around the end of the year";
  for (const char* text : {"", "4", "4:", "0:3", "4:13", "04-31:05-01", "4-:5", "a:b", "4:10:2", "-4:5"})
    EXPECT_FALSE(parse_season(text)) << text;
  EXPECT_TRUE(parse_season("02-29:4"));
}

// An hour of 1,000 Wh/m2 on surfaces that see the sun: times the cosine, and never below 0.
TEST(Weather, LightOnASurface) {
  Suns suns;
  suns.kind = SunKind::radiation;
  suns.list.push_back({glm::normalize(glm::dvec3(3, 4, 0)), 60, 0, 5, 1000});  // in the east
  const Scene scene = testing::map_scene({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 0, 9}}, "f 1 2 3\nf 1 4 2\n");
  const FrameGeometry frame = frame_of(scene);
  const Geometry geometry = geometry_of(frame);
  const Receivers faces = face_receivers(scene, frame, {}).value();
  const SunHours hours = sun_hours(geometry, faces, suns, {.months = true}).value();
  EXPECT_NEAR(hours.light[0], 800, 1e-4) << "upward";
  EXPECT_EQ(hours.light[1], 0) << "south";
  EXPECT_EQ(hours.months[5], hours.light[0]);
  EXPECT_EQ(value_of({scene, frame, faces, suns, hours}, 0), hours.light[0] / 1000);
  const std::vector<glm::dvec3> at(4, glm::dvec3(0, 40, 0));
  const std::vector<glm::vec3> normals{{2, 0, 0}, {0.3f, 0.4f, 0}, {-1, 0, 0}, {0, 0, 1}};
  const std::vector<std::uint32_t> ends{1, 2, 3, 4};
  const auto points =
      sun_hours(geometry, {.positions = at, .normals = normals}, ends, suns.list, {.light = true});
  const double expected[] = {600, 1000, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(points->light[i], expected[i], 1e-4) << i;
  EXPECT_NE(sun_hours(geometry, {.positions = at}, ends, suns.list, {.light = true})
                .error()
                .message.find("point 0 lies on no face"),
            std::string::npos);
}

TEST(Weather, PointsWithoutANormalAreRefusedBeforeTheWork) {
  const FrameGeometry frame = frame_of(wall_scene());
  constexpr std::uint32_t count = (1u << 18) + 1;  // more than are asked at a time
  const std::vector<glm::dvec3> at(count, glm::dvec3(0, 40, 0));
  std::vector<glm::vec3> normals(count, glm::vec3(0, 1, 0));
  normals.back() = {0, 0, 0};
  const std::vector<std::uint32_t> ends{count - 1, count};
  const std::vector<Sun> suns{{}};
  bool begun = false;
  const auto hours = sun_hours(geometry_of(frame), {.positions = at, .normals = normals}, ends, suns,
                               {.light = true}, nullptr, [&](double) { begun = true; });
  EXPECT_NE(hours.error().message.find("point 262144 lies on no face"), std::string::npos);
  EXPECT_FALSE(begun);
}

TEST(Weather, BothSidesOfAFace) {
  Suns suns;
  suns.kind = SunKind::radiation;
  suns.list.push_back({glm::normalize(glm::dvec3(0, 1, -1)), 60, 0, 5, 1000});             // in the north
  const Scene scene = testing::map_scene({{0, 0, 0}, {9, 0, 0}, {9, 0, 9}}, "f 1 2 3\n");  // it faces south
  const FrameGeometry frame = frame_of(scene);
  for (const bool both : {false, true}) {
    const Receivers face = face_receivers(scene, frame, {.both_sides = both}).value();
    EXPECT_NEAR(sun_hours(geometry_of(frame), face, suns, {}).value().light[0],
                both ? 1000 * std::sqrt(0.5) : 0, 1e-4);
  }
}

TEST(Weather, Tables) {
  const Scene scene = wall_scene();
  const FrameGeometry frame = frame_of(scene);
  const Receivers faces = face_receivers(scene, frame, {.per_face = 1}).value();
  const auto weather = weather_in(epw_text("48,0,0", {{2003, 6, 21, 13, 500, 0}, {2003, 7, 21, 13, 700, 0}}));
  const Suns suns = suns_of(*weather, {}).value();
  const SunHours hours = sun_hours(geometry_of(frame), faces, suns, {.months = true}).value();
  const std::string csv = csv_of({scene, frame, faces, suns, hours});
  EXPECT_NE(csv.find("area_m2,kwh_m2,hours,first_sun,last_sun,direct_kwh_m2_01,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",2,2003-06-21T12:30:00Z,2003-07-21T12:30:00Z,0,0,0,0,0,0."), std::string::npos) << csv;
  const std::string json = json_of({scene, frame, faces, suns, hours});
  EXPECT_NE(json.find("\"unit\": \"kWh/m2\""), std::string::npos);
  EXPECT_NE(json.find("\"model\": \"direct normal radiation"), std::string::npos);
}

}  // namespace
}  // namespace tenebra::sun
