#include "sun/positions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace tenebra::sun {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double day_s = 86400, century_days = 36525;
constexpr double j2000_s = 946728000;  // 2000-01-01 12:00, seconds since 1970
/// Terrestrial time is ahead of UTC by this much in 2026. Two minutes more or less move the sun by 0.0014
/// degrees.
constexpr double ahead_s = 69;

double in_turn(double degrees) {
  return degrees - 360 * std::floor(degrees / 360);
}

/// A term of the Earth's longitude: amplitude in 1e-8 radians, phase in radians, radians in 1,000 years.
struct Term {
  double amplitude, phase, frequency;
};
/// The largest terms of VSOP87, as Meeus, Appendix III, and Reda and Andreas list them. Those left out sum to
/// at most 0.003 degrees from 1900 to 2100.
constexpr Term earth_terms[] = {{175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
                                {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
                                {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
                                {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
                                {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
                                {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
                                {902, 2.045, 26.298},        {857, 3.508, 398.149},
                                {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
                                {505, 4.583, 18849.228},     {492, 4.205, 775.523},
                                {357, 2.92, 0.067},          {317, 5.849, 11790.629},
                                {284, 1.899, 796.298}};
/// The same of what grows with time.
constexpr Term growing_terms[] = {
    {628331966747, 0, 0}, {206059, 2.678235, 6283.07585}, {4303, 2.6351, 12566.1517}, {425, 1.59, 3.523}};

double sum_of(std::span<const Term> terms, double millennia) {
  double sum = 0;
  for (const Term& term : terms) sum += term.amplitude * std::cos(term.phase + term.frequency * millennia);
  return sum * 1e-8;
}

/// Of the Earth as seen from the sun, degrees.
double earth_longitude(double millennia) {
  constexpr double squared_term = 52919e-8;
  return (sum_of(earth_terms, millennia) +
          millennia * (sum_of(growing_terms, millennia) + millennia * squared_term)) /
         degree;
}

/// Against the stars, as seen from the Earth's centre, degrees.
struct Equatorial {
  double right_ascension, declination;
  double sidereal;  ///< apparent sidereal time at longitude 0
};

Equatorial equatorial(double utc_s) {
  const double days = (utc_s - j2000_s) / day_s, t = (days + ahead_s / day_s) / century_days;
  const double mean_longitude = in_turn(earth_longitude(t / 10) + 180);
  const double moon_node = (125.04 - 1934.136 * t) * degree;
  const double nutation = -0.00478 * std::sin(moon_node) - 0.00037 * std::sin(2 * mean_longitude * degree);
  constexpr double aberration = -0.00569;
  const double longitude = (mean_longitude + nutation + aberration) * degree;
  const double tilt = (23.4392911 - 0.0130042 * t + 0.00256 * std::cos(moon_node)) * degree;
  return {std::atan2(std::cos(tilt) * std::sin(longitude), std::cos(longitude)) / degree,
          std::asin(std::sin(tilt) * std::sin(longitude)) / degree,
          in_turn(280.46061837 + 360.98564736629 * days + nutation * std::cos(tilt))};
}

/// What air adds to an altitude, degrees; Meeus (16.4).
double refracted(double altitude) {
  constexpr double lowest = -1;  // below it the sun has set in any air, and the formula ends at -5
  if (altitude < lowest) return 0;
  return 1.02 / 60 / std::tan((altitude + 10.3 / (altitude + 5.11)) * degree);
}

}  // namespace

Position position(const Place& place, double utc_s, Refraction refraction) {
  const Equatorial sun = equatorial(utc_s);
  const double hour = (sun.sidereal + place.longitude_deg - sun.right_ascension) * degree;
  const double latitude = place.latitude_deg * degree, declination = sun.declination * degree;
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(hour);
  const double north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour);
  const double east = -std::cos(declination) * std::sin(hour);
  constexpr double parallax = 0.00244;  // of a sun at the horizon: the place is not the Earth's centre
  double altitude = std::asin(std::clamp(up, -1.0, 1.0)) / degree;
  altitude -= parallax * std::cos(altitude * degree);
  if (refraction == Refraction::standard) altitude += refracted(altitude);
  return {in_turn(std::atan2(east, north) / degree), altitude};
}

glm::dvec3 direction(const Position& position, double north_deg) {
  const double azimuth = (position.azimuth_deg + north_deg) * degree;
  const double altitude = position.altitude_deg * degree;
  return {std::cos(altitude) * std::sin(azimuth), std::sin(altitude),
          -std::cos(altitude) * std::cos(azimuth)};
}

}  // namespace tenebra::sun
