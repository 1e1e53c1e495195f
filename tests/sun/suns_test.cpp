// Suns of days and of files; and what is no day, place or number.
#include <gtest/gtest.h>

#include "sun/columns.h"
#include "sun_scenes.h"

namespace tenebra::sun {
namespace {

using testing::day_of_suns;

double minutes(const Suns& suns) {
  double sum = 0;
  for (const Sun& sun : suns.list) sum += sun.weight;
  return sum;
}

TEST(Suns, PolarDayAndNight) {
  const Suns summer = day_of_suns(80, "2026-06-21"), winter = day_of_suns(80, "2026-12-21");
  EXPECT_EQ(minutes(summer), 1440);
  EXPECT_TRUE(winter.list.empty());
  EXPECT_EQ(winter.below, 144u);
}

TEST(Suns, HalfADayAtTheEquinox) {
  EXPECT_NEAR(minutes(day_of_suns(48, "2026-03-20", 1)), 720, 3);
}

TEST(Suns, MiddleDayOfEachRunStandsForAll) {
  SunTimes times;
  times.place = {85, 0};
  times.days = parse_days("2026-05-01:2026-05-31:7").value();
  const Suns suns = suns_of(times).value();
  EXPECT_DOUBLE_EQ(minutes(suns), 31 * 1440);
  EXPECT_EQ(time_text(suns.list.front().utc_s, 0), "2026-05-04T00:05:00Z");
  EXPECT_EQ(time_text(suns.list.back().utc_s, 0), "2026-05-30T23:55:00Z");  // of the last three
}

TEST(Suns, DaysBeginAtMidnightOfTheZone) {
  SunTimes times;
  times.place = {80, 139.7};
  times.days = parse_days("2026-06-21:2026-06-21").value();
  times.zone_min = parse_zone("+09:00").value();
  const Suns suns = suns_of(times).value();
  EXPECT_EQ(time_text(suns.list.front().utc_s, 0), "2026-06-20T15:05:00Z");
  EXPECT_EQ(time_text(suns.list.front().utc_s, times.zone_min), "2026-06-21T00:05:00+09:00");
  EXPECT_EQ(suns.list.front().month, 5);
}

TEST(Suns, DaysOfTheCalendar) {
  EXPECT_TRUE(parse_day("2024-02-29"));
  EXPECT_EQ(parse_day("2026-02-29").error().message, "found 2026-02-29, which is no day of the calendar");
  for (const char* text : {"", "21.06.2026", "2026-6-21", "26-06-21xx", "9999-01-01", "2026-13-01"})
    EXPECT_FALSE(parse_day(text)) << text;
  for (const char* text : {"2026-06-21", "2026-06-21:", "2026-06-22:2026-06-21", "2026-06-21:2026-06-22:0",
                           "2026-06-21:2026-06-22:x", "2026-06-21:2026-06-22:1:1"})
    EXPECT_FALSE(parse_days(text)) << text;
  EXPECT_EQ(parse_zone("-03:30").value(), -210);
  EXPECT_EQ(zone_text(-210), "-03:30");
  for (const char* text : {"", "2", "+2", "+02:60", "+15:00", "Europe/Berlin"})
    EXPECT_FALSE(parse_zone(text)) << text;
}

Expected<Suns> suns_in(const std::string& text, UpAxis up = UpAxis::y) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "suns.csv", text);
  FileFrame frame;
  frame.up = up;
  return read_suns(folder / "suns.csv", frame, 0);
}

TEST(Suns, OfAFile) {
  const Suns angles =
      suns_in("\xef\xbb\xbfname, Azimuth ,altitude,weight\r\n# morning\r\n\r\na,90,45,2\r\nb,0,-1,1\r\n")
          .value();
  ASSERT_EQ(angles.list.size(), 1u);
  EXPECT_EQ(angles.below, 1u);
  EXPECT_EQ(angles.list[0].weight, 2);
  EXPECT_FALSE(angles.timed());
  const Suns quoted = suns_in("\"name, of it\",x,y,z\n\"a, 1\",0,1,0\n").value();
  ASSERT_EQ(quoted.list.size(), 1u);
  EXPECT_EQ(quoted.list[0].to_sun, glm::dvec3(0, 1, 0)) << "a comma within quotes belongs to its cell";
  const Suns axes = suns_in("x,y,z\n3,0,3\n", UpAxis::z).value();
  EXPECT_NEAR(glm::length(axes.list[0].to_sun - angles.list[0].to_sun), 0, 1e-15);
}

TEST(Suns, RefusesFilesInASentence) {
  const auto refusal = [](const std::string& text) {
    const auto suns = suns_in(text);
    return suns ? "nothing" : suns.error().message;
  };
  EXPECT_NE(refusal("").find("found no row of numbers"), std::string::npos);
  EXPECT_NE(refusal("x,y\n1,2\n").find("found no columns x, y, z"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n0,1,0\n1,2\n").find("suns.csv:3: found nothing for z, expected a number"),
            std::string::npos);
  EXPECT_NE(refusal("x,y,z\n1,nan,0\n").find("found nan for y"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n0,0,0\n").find("sun 1 has no direction"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,weight\n0,1,0,-1\n").find("weight -1"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,weight\n0,1,0,1e308\n").find("weight 1e+308"), std::string::npos);
  EXPECT_NE(refusal("azimuth,altitude\n0,120\n").find("altitude 120"), std::string::npos);
}

TEST(Suns, AMillionAtMost) {
  SunTimes times;
  times.days = parse_days("1900-01-01:2100-01-01").value();
  times.step_min = 1;
  EXPECT_FALSE(suns_of(times));
}

}  // namespace
}  // namespace tenebra::sun
