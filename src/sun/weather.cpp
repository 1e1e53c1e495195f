#include "sun/weather.h"

#include <array>
#include <cmath>
#include <string>

#include "base/fail.h"
#include "io/input_file.h"
#include "sun/columns.h"

namespace tenebra::sun {
namespace {

constexpr std::size_t most_weather_bytes = std::size_t{1} << 26, header_lines = 8;

/// A line of the file in its cells, and where to say that it stands.
struct WeatherLine {
  std::string file;
  std::size_t number = 0;
  std::vector<std::string_view> cells;

  /// Cell `i` as a number from `low` to `high`.
  Expected<double> in(std::size_t i, const char* name, double low, double high) const {
    const std::string_view cell = i < cells.size() ? cells[i] : "";
    const auto found = finite_number(cell);
    if (found && *found >= low && *found <= high) return *found;
    return base::fail("{}:{}: found {} for the {}, expected a number from {} to {}", file, number,
                      cell.empty() ? "nothing" : std::string(cell.substr(0, 40)), name, low, high);
  }
};

struct CellRange {
  std::size_t cell;
  const char* name;
  double low, high;
};

/// Hands out each range's number.
template <std::size_t Count>
Expected<std::array<double, Count>> numbers_of(const WeatherLine& line, const CellRange (&ranges)[Count]) {
  std::array<double, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    const auto number = line.in(ranges[i].cell, ranges[i].name, ranges[i].low, ranges[i].high);
    if (!number) return tl::unexpected(number.error());
    numbers[i] = *number;
  }
  return numbers;
}

Expected<void> read_header(const WeatherLine& line, Weather& out) {
  if (line.number == 1) {
    if (line.cells.front() != "LOCATION")
      return base::fail("{}:1: found no LOCATION, expected an EPW weather file, which begins with it",
                        line.file);
    constexpr CellRange ranges[] = {
        {6, "latitude", -90, 90}, {7, "longitude", -180, 180}, {8, "time zone", -14, 14}};
    const auto found = numbers_of(line, ranges);
    if (!found) return tl::unexpected(found.error());
    out.place = {(*found)[0], (*found)[1]};
    out.zone_min = static_cast<int>(std::lround(60 * (*found)[2]));
  }
  if (line.number == header_lines) {
    if (line.cells.front() != "DATA PERIODS")
      return base::fail("{}:{}: found no DATA PERIODS, expected it in the last line of an EPW file's header",
                        line.file, header_lines);
    const auto records = line.in(2, "number of records in an hour", 1, 60);
    if (!records) return tl::unexpected(records.error());
    if (*records != 1)
      return base::fail("{}:{}: found {} records in an hour, expected 1", line.file, header_lines, *records);
  }
  return {};
}

Expected<void> read_hour(const WeatherLine& line, Weather& out) {
  constexpr double missing = 9999;
  constexpr CellRange ranges[] = {{0, "year", 1900, 2100},
                                  {1, "month", 1, 12},
                                  {2, "day", 1, 31},
                                  {3, "hour", 1, 24},
                                  {14, "direct normal radiation", 0, 1e9},
                                  {15, "diffuse horizontal radiation", 0, 1e9}};
  const auto found = numbers_of(line, ranges);
  if (!found) return tl::unexpected(found.error());
  const auto whole = [&](std::size_t i) { return static_cast<unsigned>((*found)[i]); };
  const std::chrono::month_day day{std::chrono::month(whole(1)), std::chrono::day(whole(2))};
  if (!day.ok())
    return base::fail("{}:{}: found day {} of month {}, expected one of the calendar", line.file, line.number,
                      whole(2), whole(1));
  // 29 February of a year without one is the first of March.
  const auto days = std::chrono::sys_days(std::chrono::year(static_cast<int>(whole(0))) / day.month() / 1) +
                    std::chrono::days(whole(2) - 1);
  const double begin_s = 86400.0 * static_cast<double>(days.time_since_epoch().count()) +
                         3600.0 * static_cast<double>(whole(3) - 1);
  const auto light = [&](std::size_t i) { return (*found)[i] < missing ? (*found)[i] : 0; };
  out.missing += (*found)[4] >= missing || (*found)[5] >= missing;
  out.hours.push_back({begin_s, day, light(4), light(5)});
  return {};
}

}  // namespace

Expected<Weather> read_weather(const std::filesystem::path& file) {
  const auto text = io::read_file(file, most_weather_bytes);
  if (!text) return tl::unexpected(text.error());
  Weather weather;
  WeatherLine line{file.string()};
  Lines lines(*text);
  while (const auto words = lines.next()) {
    line.number = lines.number();
    if (line.number > header_lines && words->empty()) continue;
    split_cells(*words, line.cells);
    const auto read = line.number <= header_lines ? read_header(line, weather) : read_hour(line, weather);
    if (!read) return tl::unexpected(read.error());
  }
  if (weather.hours.empty())
    return base::fail("{}: found no hour, expected an EPW file: {} lines of header and a line for each hour",
                      file.string(), header_lines);
  return weather;
}

}  // namespace tenebra::sun
