#include "sun/times.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/fail.h"
#include "base/number_in.h"

namespace tenebra::sun {
namespace {

using std::chrono::year_month_day;

/// `digits` digits alone.
std::optional<int> digits_from(std::string_view text, std::size_t digits) {
  if (text.size() != digits || text.starts_with('-')) return std::nullopt;
  return base::number_in<int>(text);
}

/// A month or a day of it; of a month the first day or the last.
std::optional<std::chrono::month_day> month_day_in(std::string_view text, bool is_last) {
  const std::size_t dash = text.find('-');
  const auto month = digits_from(text.substr(0, dash), std::min<std::size_t>({dash, text.size(), 2}));
  const auto day =
      dash == text.npos ? std::optional(is_last ? 31 : 1) : digits_from(text.substr(dash + 1), 2);
  if (!month || !day) return std::nullopt;
  const std::chrono::month_day found{std::chrono::month(static_cast<unsigned>(*month)),
                                     std::chrono::day(static_cast<unsigned>(*day))};
  return (dash == text.npos ? found.month().ok() : found.ok()) ? std::optional(found) : std::nullopt;
}

year_month_day local_day(double utc_s, int zone_min) {
  const double days = std::floor((utc_s + 60.0 * zone_min) / 86400);
  return year_month_day(Day(std::chrono::days(static_cast<int>(days))));
}

}  // namespace

Expected<Day> parse_day(const std::string& text) {
  const std::string_view t(text);
  constexpr int first_year = 1900, last_year = 2100;
  const auto fail = [&] {
    return base::fail("found {}, expected a day from {} to {}, like 2026-06-21", text, first_year, last_year);
  };
  if (t.size() != 10 || t[4] != '-' || t[7] != '-') return fail();
  const auto year = digits_from(t.substr(0, 4), 4), month = digits_from(t.substr(5, 2), 2),
             day = digits_from(t.substr(8, 2), 2);
  if (!year || !month || !day || *year < first_year || *year > last_year) return fail();
  const year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                            std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return base::fail("found {}, which is no day of the calendar", text);
  return Day(date);
}

Expected<Days> parse_days(const std::string& text) {
  const std::size_t colon = text.find(':'), second = text.find(':', colon + 1);
  if (colon == text.npos)
    return base::fail("found {}, expected FIRST:LAST or FIRST:LAST:N, like 2026-01-01:2026-12-31:7", text);
  const auto first = parse_day(text.substr(0, colon));
  if (!first) return tl::unexpected(first.error());
  const auto last = parse_day(text.substr(colon + 1, second == text.npos ? second : second - colon - 1));
  if (!last) return tl::unexpected(last.error());
  Days days{*first, *last, 1};
  if (second != text.npos) {
    const std::string every = text.substr(second + 1);
    const auto number = every.empty() ? std::nullopt : digits_from(every, every.size());
    if (!number || *number < 1 || every.size() > 3)
      return base::fail("found {}, expected 1 to 999 days after the second colon", every);
    days.every = *number;
  }
  if (days.last < days.first) return base::fail("found {}, expected the first day before the last", text);
  return days;
}

Expected<Season> parse_season(const std::string& text) {
  const std::string_view t(text);
  const std::size_t colon = t.find(':');
  const auto first = month_day_in(t.substr(0, colon), false),
             last = colon == t.npos ? std::nullopt : month_day_in(t.substr(colon + 1), true);
  if (!first || !last)
    return base::fail(
        "found {}, expected months or days of them from FIRST to LAST, like 4:10 or 04-15:10-31", text);
  return Season{*first, *last};
}

Expected<int> parse_zone(const std::string& text) {
  if (text == "UTC" || text == "Z") return 0;
  const bool signed_time = text.size() == 6 && (text[0] == '+' || text[0] == '-') && text[3] == ':';
  const auto hours = signed_time ? digits_from(text.substr(1, 2), 2) : std::nullopt,
             minutes = signed_time ? digits_from(text.substr(4, 2), 2) : std::nullopt;
  constexpr int most = 14 * 60;
  if (!hours || !minutes || *minutes > 59 || *hours * 60 + *minutes > most)
    return base::fail("found {}, expected UTC or hours and minutes ahead of it, like +02:00 or -03:30", text);
  const int ahead = *hours * 60 + *minutes;
  return text[0] == '-' ? -ahead : ahead;
}

std::string zone_text(int zone_min) {
  if (zone_min == 0) return "UTC";
  return fmt::format("{}{:02}:{:02}", zone_min < 0 ? '-' : '+', std::abs(zone_min) / 60,
                     std::abs(zone_min) % 60);
}

std::string day_text(Day day) {
  const year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

std::string time_text(double utc_s, int zone_min) {
  const double rounded = std::floor(utc_s + 0.5), local = rounded + 60.0 * zone_min;
  const int second = static_cast<int>(local - 86400 * std::floor(local / 86400));
  return fmt::format("{}T{:02}:{:02}:{:02}{}", day_text(Day(local_day(rounded, zone_min))), second / 3600,
                     second / 60 % 60, second % 60, zone_min == 0 ? "Z" : zone_text(zone_min));
}

std::chrono::month_day day_of_year(double utc_s, int zone_min) {
  const year_month_day date = local_day(utc_s, zone_min);
  return {date.month(), date.day()};
}

int month_of(double utc_s, int zone_min) {
  return static_cast<int>(static_cast<unsigned>(local_day(utc_s, zone_min).month())) - 1;
}

}  // namespace tenebra::sun
