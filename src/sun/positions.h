// Where the sun stands in the sky of a place on Earth.
#pragma once

#include <glm/glm.hpp>

namespace tenebra::sun {

struct Place {
  double latitude_deg = 0;   ///< north positive, -90 to 90
  double longitude_deg = 0;  ///< east positive, -180 to 180
};

struct Position {
  double azimuth_deg = 0;   ///< clockwise from true north, 0 to 360
  double altitude_deg = 0;  ///< of the disc's centre above the horizon of a flat, open place
};

/// Whether the altitude is that of the light in vacuum or, higher by up to half a degree, in air of 1010 hPa
/// and 10 degrees Celsius.
enum class Refraction { none, standard };

/// The sun at `utc_s`, seconds since 1970-01-01 00:00 UTC, after Meeus, Astronomical Algorithms, 2nd edition,
/// chapters 12, 13, 22 and 25, with the terms of VSOP87 that count: from 1950 to 2100 within 0.003 degrees of
/// Reda and Andreas 2004 (SPA).
Position position(const Place& place, double utc_s, Refraction refraction = Refraction::none);

/// Unit vector towards a sun in the scene's axes: Y up and, where `north_deg` is 0, -Z true north and X east:
/// in files with Z up Y is north. `north_deg`: how far true north is turned from there, clockwise seen from
/// above.
glm::dvec3 direction(const Position& position, double north_deg = 0);

}  // namespace tenebra::sun
