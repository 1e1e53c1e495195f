// Days and times of day as users write them. Times are seconds since 1970-01-01 00:00 UTC, without leap
// seconds.
#pragma once

#include <chrono>
#include <string>

#include <tenebra/expected.h>

namespace tenebra::sun {

using Day = std::chrono::sys_days;

/// Days from `first` to `last`, of each run of `every` days the middle one, which stands for all of them.
struct Days {
  Day first{}, last{};
  int every = 1;
};

/// Days of every year, around its end where the first is the later one.
struct Season {
  std::chrono::month_day first{}, last{};

  bool holds(std::chrono::month_day day) const {
    return first <= last ? first <= day && day <= last : first <= day || day <= last;
  }
};

Expected<Day> parse_day(const std::string& text);    ///< 2026-06-21, 1900 to 2100
Expected<Days> parse_days(const std::string& text);  ///< A:B or A:B:N
/// Months, 4:10, or days, 04-15:10-31; the last counts too.
Expected<Season> parse_season(const std::string& text);
/// Minutes that a zone's clocks are ahead of UTC: UTC, +02:00, -03:30; at most 14 hours.
Expected<int> parse_zone(const std::string& text);

std::string zone_text(int zone_min);                ///< "UTC", "+02:00"
std::string day_text(Day day);                      ///< "2026-06-21"
std::string time_text(double utc_s, int zone_min);  ///< "2026-06-21T05:25:00+02:00", to the second
/// By the zone's clocks.
std::chrono::month_day day_of_year(double utc_s, int zone_min);
/// 0 to 11, likewise.
int month_of(double utc_s, int zone_min);

}  // namespace tenebra::sun
