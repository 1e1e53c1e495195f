// The day whose sun the window shows: where and when, and what the panel wants of it.
#pragma once

#include "sun/suns.h"

namespace tenebra::viewer {

struct SunDay {
  sun::Place place{48.14, 11.58};
  sun::Day day{};        ///< by the zone's clocks
  int minute = 12 * 60;  ///< of the day, 0 to 1439
  int zone_min = 0;      ///< as sun::SunTimes
  float north_deg = 0;   ///< likewise
  bool moves = true;     ///< a change of the above turns the scene's sun
  bool colours = false;  ///< hours as colours are wanted
  int dark_light = -1;   ///< the light that is off because its sun has set; -1: none
  bool open = false;     ///< its section is: the view shows the sun's path
};

/// A day with today's date.
SunDay sun_today();

/// Both have the same suns; the minute is not of the day.
bool same_suns(const SunDay& a, const SunDay& b);

/// The sun at the minute, and the way to it in the scene's axes.
sun::Position sun_at(const SunDay& day);
glm::dvec3 way_to_sun(const SunDay& day);

/// One each ten minutes, in the middle of its step, above the horizon.
sun::Suns suns_of_day(const SunDay& day);

/// The day of its year, 1 to 366, and the day of the same year with that number, at most its last.
int day_of_year(sun::Day day);
sun::Day with_day_of_year(sun::Day day, int number);

}  // namespace tenebra::viewer
