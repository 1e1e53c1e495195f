// Small weather files.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include "sun/weather.h"
#include "sun_scenes.h"

namespace tenebra::testing {

/// Year, month, day, hour, direct and diffuse light.
struct EpwHour {
  int year, month, day, hour;
  double direct, diffuse;
};
/// `place`: latitude, longitude, hours ahead of UTC.
inline std::string epw_text(const std::string& place, const std::vector<EpwHour>& hours, int records = 1) {
  std::string text = "LOCATION,Town,-,X,TMY,1," + place +
                     ",500.0\nDESIGN CONDITIONS,0\n"
                     "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
                     "COMMENTS 1,\"a, b\"\nCOMMENTS 2,\n";
  text += fmt::format("DATA PERIODS,1,{},Data,Sunday, 1/ 1,12/31\r\n", records);
  for (const EpwHour& h : hours)
    text += fmt::format("{},{},{},{},60,?9?9?9,1,2,3,4,5,6,7,8,{},{},9,9\r\n", h.year, h.month, h.day, h.hour,
                        h.direct, h.diffuse);
  return text;
}

inline Expected<sun::Weather> weather_in(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder / "w.epw", text);
  return sun::read_weather(folder / "w.epw");
}

}  // namespace tenebra::testing
