// A weather file's hours of light.
#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

#include <tenebra/expected.h>
#include "sun/positions.h"

namespace tenebra::sun {

struct WeatherHour {
  double begin_s = 0;            ///< seconds since 1970 by the zone's clocks
  std::chrono::month_day day{};  ///< as the file has it
  double direct_wh_m2 = 0;       ///< on a surface at right angles to the sun
  double diffuse_wh_m2 = 0;      ///< of the sky, on a horizontal surface
};

/// A year by hours, of months that may come from several years.
struct Weather {
  Place place;
  int zone_min = 0;  ///< what its clocks, without daylight saving, are ahead of UTC
  std::vector<WeatherHour> hours;
  std::size_t missing = 0;  ///< hours without one of both numbers, which count as 0
};

/// An EPW file, as EnergyPlus documents it: eight lines of header, the first with the place and the zone,
/// then a line for each hour, of which hour 1 ends at 1 o'clock; 9999 and more is missing. Refuses, by its
/// line, what does not follow this, and files of more than 64 MiB or of parts of hours.
Expected<Weather> read_weather(const std::filesystem::path& file);

}  // namespace tenebra::sun
