#include "window/frames/sun_day.h"

#include <algorithm>
#include <tuple>

namespace tenebra::viewer {
namespace {

sun::Day first_of_year(sun::Day day) {
  const std::chrono::year_month_day date(day);
  return sun::Day(date.year() / std::chrono::January / 1);
}

}  // namespace

SunDay sun_today() {
  SunDay today;
  today.day = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  return today;
}

bool same_suns(const SunDay& a, const SunDay& b) {
  const auto key = [](const SunDay& of) {
    return std::tuple(of.place.latitude_deg, of.place.longitude_deg, of.day, of.zone_min, of.north_deg);
  };
  return key(a) == key(b);
}

sun::Position sun_at(const SunDay& day) {
  const double midnight_s = 86400.0 * static_cast<double>(day.day.time_since_epoch().count());
  return sun::position(day.place, midnight_s + 60.0 * (day.minute - day.zone_min));
}

glm::dvec3 way_to_sun(const SunDay& day) {
  return sun::direction(sun_at(day), day.north_deg);
}

sun::Suns suns_of_day(const SunDay& day) {
  sun::SunTimes times;
  times.place = day.place, times.days = {day.day, day.day, 1};
  times.zone_min = day.zone_min, times.north_deg = day.north_deg;
  return sun::suns_of(times).value();  // 144 of them: never too many
}

int day_of_year(sun::Day day) {
  return static_cast<int>((day - first_of_year(day)).count()) + 1;
}

sun::Day with_day_of_year(sun::Day day, int number) {
  const sun::Day first = first_of_year(day);
  const bool leap = std::chrono::year_month_day(day).year().is_leap();
  return first + std::chrono::days(std::clamp(number, 1, leap ? 366 : 365) - 1);
}

}  // namespace tenebra::viewer
