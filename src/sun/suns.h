// Suns: the directions that a point is asked to see, and what each counts.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/scene.h>
#include "sun/positions.h"
#include "sun/times.h"

namespace tenebra::sun {

struct Sun {
  glm::dvec3 to_sun{0, 1, 0};  ///< unit, in the scene's axes; above the horizon
  double weight = 1;           ///< what it counts where it is seen; from place and days minutes
  double utc_s = 0;            ///< when, where Suns::timed
  int month = 0;               ///< 0 to 11, likewise
};

struct Suns {
  std::vector<Sun> list;
  bool timed = false;     ///< weights are minutes, and each sun has a time
  int zone_min = 0;       ///< what the zone's clocks are ahead of UTC; days begin by them
  std::size_t below = 0;  ///< how many were left out because they stand below the horizon
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

/// From a file with columns x, y, z (towards the sun, any length, in the axes of the scene's file) or
/// azimuth, altitude (degrees, as Position), and weight (0 or more; none: 1).
Expected<Suns> read_suns(const std::filesystem::path& file, const FileFrame& frame, double north_deg);

}  // namespace tenebra::sun
