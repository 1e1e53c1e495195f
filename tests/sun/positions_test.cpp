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

// Reda and Andreas, Solar Position Algorithm for Solar Radiation Applications, table A5.1 (e0 and the
// azimuth).
TEST(SunPosition, ExampleOfReda) {
  const Position sun = position({39.742476, -105.1786}, utc("2003-10-17", 12 + 7 + 30.5 / 60));
  EXPECT_NEAR(sun.altitude_deg, 39.872046, 0.001);
  EXPECT_NEAR(sun.azimuth_deg, 194.340241, 0.001);
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
