// The sun's place against published values and what must hold at special places and days.
#include <gtest/gtest.h>

#include <algorithm>

#include "sun/positions.h"
#include "sun/times.h"

namespace tenebra::sun {
namespace {

double utc(const std::string& day, double hour) {
  return 86400.0 * static_cast<double>(parse_day(day).value().time_since_epoch().count()) + 3600 * hour;
}

// Places on Earth from 1950 to 2100, among them the poles, both sides of the date line, leap days and suns at
// the horizon and near the zenith: azimuth and altitude without air by Reda and Andreas, Solar Position
// Algorithm for Solar Radiation Applications, as pvlib-python implements it (pvlib/spa.py, its
// calculate_deltat, height 0 m). The row of 2003 is the example of their table A5.1.
TEST(SunPosition, IsThatOfReda) {
  struct Row {
    Place place;
    const char* day;
    double hour;
    Position sun;
  };
  const Row rows[] = {
      {{48.14, 11.58}, "1950-01-01", 9, {147.94385, 12.46815}},
      {{-33.87, 151.21}, "1950-06-21", 2 + 30 / 60.0, {350.94941, 32.13456}},
      {{64.15, -21.94}, "1955-12-21", 13, {174.12190, 2.26487}},
      {{0, 0}, "1960-03-20", 12, {91.35668, 88.12081}},
      {{35.68, 139.69}, "1964-02-29", 23 + 10 / 60.0, {117.76668, 21.90816}},
      {{-54.8, -68.3}, "1968-09-22", 18, {331.94234, 31.80916}},
      {{23.436, -82.4}, "1972-06-21", 17 + 30 / 60.0, {88.63830, 89.68395}},
      {{78.22, 15.65}, "1976-06-21", 23, {0.18041, 11.65630}},
      {{-17.8, 179.9}, "1980-12-31", 23 + 59 / 60.0, {168.05993, 84.65481}},
      {{-17.8, -179.9}, "1981-01-01", 0 + 1 / 60.0, {174.96050, 84.75349}},
      {{51.507, -0.128}, "1985-06-21", 3 + 43 / 60.0, {48.90040, -0.82865}},
      {{40.71, -74}, "1988-11-05", 15 + 20 / 60.0, {157.66721, 30.47259}},
      {{-23.436, 133.9}, "1992-12-21", 3, {90.40864, 89.43176}},
      {{39.742476, -105.1786}, "2003-10-17", 19 + 30 / 60.0 + 30 / 3600.0, {194.34028, 39.87205}},
      {{1.35, 103.82}, "2000-02-29", 5, {155.02800, 79.84367}},
      {{90, 0}, "2008-07-04", 6, {88.89050, 22.83741}},
      {{-90, 0}, "2012-12-21", 12, {359.57590, 23.43354}},
      {{55.75, 37.62}, "2017-04-15", 4, {90.69689, 12.37227}},
      {{48.14, 11.58}, "2026-06-21", 5 + 25 / 60.0, {75.50867, 18.76814}},
      {{28.61, 77.21}, "2035-08-01", 12 + 40 / 60.0, {283.97193, 12.21420}},
      {{-1.29, 36.82}, "2048-03-20", 9 + 30 / 60.0, {59.53097, 87.10196}},
      {{59.33, 18.07}, "2060-10-10", 10 + 10 / 60.0, {173.36216, 23.47454}},
      {{-36.85, 174.76}, "2075-01-15", 7 + 45 / 60.0, {242.14553, -1.36023}},
      {{19.43, -99.13}, "2088-05-16", 18 + 35 / 60.0, {272.37521, 89.53421}},
      {{48.14, 11.58}, "2100-02-28", 12, {190.10038, 33.52728}},
      {{67.9, -60}, "2100-12-31", 16, {179.32590, -0.95377}},
  };
  for (const Row& row : rows) {
    const double off =
        glm::length(direction(position(row.place, utc(row.day, row.hour))) - direction(row.sun));
    EXPECT_LT(glm::degrees(off), 0.003) << row.day;
  }
}

TEST(SunPosition, StandsInTheZenithOfTheTropicAtNoon) {
  double highest = 0;
  for (int minute = 0; minute < 1440; ++minute)
    highest = std::max(highest, position({23.436, 0}, utc("2026-06-21", minute / 60.0)).altitude_deg);
  EXPECT_GT(highest, 89.8);  // a minute is a quarter of a degree
}

// The equinox of March 2026 is at 14:46 UTC.
TEST(SunPosition, IsOnTheHorizonOfThePolesAtTheEquinox) {
  for (const double pole : {-90.0, 90.0})
    EXPECT_NEAR(position({pole, 0}, utc("2026-03-20", 14 + 46.0 / 60)).altitude_deg, 0, 0.01);
}

// Almanacs: the upper limb rises in London at 04:43 summer time; by convention the centre is then at -0.833.
TEST(SunPosition, SunriseOfLondon) {
  EXPECT_NEAR(position({51.507, -0.128}, utc("2026-06-21", 3 + 43.0 / 60)).altitude_deg, -0.833, 0.1);
}

TEST(SunPosition, DateLineIsOnePlace) {
  const double when = utc("2026-12-31", 23.9);
  const Position east = position({-17, 180}, when), west = position({-17, -180}, when);
  EXPECT_NEAR(glm::length(direction(east) - direction(west)), 0, 1e-12);
}

TEST(SunPosition, AirLiftsTheSunByHalfADegreeAtTheHorizon) {
  const double when = utc("2026-06-21", 3 + 51.0 / 60);
  const double bare = position({51.507, -0.128}, when).altitude_deg;
  EXPECT_NEAR(position({51.507, -0.128}, when, Refraction::standard).altitude_deg - bare, 0.48, 0.1);
  const double noon = utc("2026-06-21", 12);
  EXPECT_NEAR(position({51.5, 0}, noon, Refraction::standard).altitude_deg,
              position({51.5, 0}, noon).altitude_deg, 0.01);
}

TEST(SunPosition, NorthTurnsClockwise) {
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; };
  EXPECT_TRUE(near(direction({0, 0}), {0, 0, -1}));
  EXPECT_TRUE(near(direction({90, 0}), {1, 0, 0}));
  EXPECT_TRUE(near(direction({0, 0}, 90), {1, 0, 0}));
  EXPECT_TRUE(near(direction({0, 90}), {0, 1, 0}));
}

}  // namespace
}  // namespace tenebra::sun
