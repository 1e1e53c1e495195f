// Suns: the directions that a point is asked to see, and what each counts.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <vector>

#include <tenebra/scene.h>
#include "sun/positions.h"
#include "sun/times.h"
#include "sun/weather.h"

namespace tenebra::sun {

struct Sun {
  glm::dvec3 to_sun{0, 1, 0};  ///< unit, in the scene's axes; above the horizon
  double weight = 1;           ///< what it counts where it is seen; minutes where SunKind has them
  double utc_s = 0;            ///< when, where Suns::timed()
  int month = 0;               ///< 0 to 11, likewise
  double light_wh_m2 = 0;      ///< what a surface at right angles to it gets while it is seen
};

/// What suns count.
enum class SunKind {
  sums,      ///< weights of a file, without times
  minutes,   ///< of sun
  radiation  ///< light, and minutes beside it
};

struct Suns {
  std::vector<Sun> list;
  SunKind kind = SunKind::sums;
  int zone_min = 0;       ///< what the zone's clocks are ahead of UTC; days begin by them
  std::size_t below = 0;  ///< how many were left out because they stand below the horizon
  double lost_wh_m2 = 0;  ///< light of hours in which the sun stays there
  /// What the sky sends onto an open horizontal surface on each day, with SunKind::radiation.
  std::map<std::chrono::month_day, double> diffuse_wh_m2{};

  bool timed() const { return kind != SunKind::sums; }
};

/// When and from where.
struct SunTimes {
  Place place;
  Days days;
  double step_min = 10;  ///< divides the day; a sun stands where it is in the middle of its step
  int zone_min = 0;
  double north_deg = 0;  ///< as direction() takes it
  Refraction refraction = Refraction::none;
};
/// The suns of all steps. Fails where they are more than a million.
Expected<Suns> suns_of(const SunTimes& times);

/// Which hours of a weather file, and how.
struct WeatherTimes {
  std::optional<Season> days;  ///< none: all
  double step_min = 60;        ///< divides the hour
  double north_deg = 0;        ///< as direction() takes it
  Refraction refraction = Refraction::none;
};
/// A sun for each step, in the middle of what it is up of it, to a minute: these minutes are its weight, and
/// the steps of an hour share the hour's light by theirs. Fails where they are more than a million.
Expected<Suns> suns_of(const Weather& weather, const WeatherTimes& times);

/// From a file with columns x, y, z (towards the sun, any length, in the axes of the scene's file) or
/// azimuth, altitude (degrees, as Position), and weight (0 or more; none: 1).
Expected<Suns> read_suns(const std::filesystem::path& file, const FileFrame& frame, double north_deg);

}  // namespace tenebra::sun
