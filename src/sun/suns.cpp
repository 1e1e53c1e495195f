#include "sun/suns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/fail.h"
#include "sun/columns.h"

namespace tenebra::sun {
namespace {

constexpr std::size_t most_suns = 1'000'000;

/// Adds a sun if it stands above the horizon.
void add_sun(const Sun& sun, Suns& suns) {
  if (sun.to_sun.y > 0) {
    suns.list.push_back(sun);
  } else {
    ++suns.below;
    suns.lost_wh_m2 += sun.light_wh_m2;
  }
}

/// What the sun is up of a time: how long, and the middle of it.
struct Lit {
  double minutes, middle_s;
};
Lit lit_part(const Place& place, double begin_s, double minutes, Refraction refraction) {
  const auto is_up = [&](double part) {
    return position(place, begin_s + 60 * minutes * part, refraction).altitude_deg > 0;
  };
  const int ups = is_up(0) + is_up(0.5) + is_up(1);
  if (ups == 0 || ups == 3) return {ups == 0 ? 0 : minutes, begin_s + 30 * minutes};
  const int parts = static_cast<int>(std::ceil(minutes));
  int lit = 0;
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    if (const double part = (i + 0.5) / parts; is_up(part)) ++lit, sum += part;
  return {minutes * lit / parts, begin_s + 60 * minutes * (lit > 0 ? sum / lit : 0.5)};
}

void add_hour(const Weather& weather, const WeatherHour& hour, const WeatherTimes& times, int steps,
              Suns& suns) {
  const double step_min = 60.0 / steps, begin_s = hour.begin_s - 60.0 * weather.zone_min;
  std::vector<Lit> lit;
  double minutes = 0;
  for (int i = 0; i < steps; ++i) {
    lit.push_back(lit_part(weather.place, begin_s + 60 * step_min * i, step_min, times.refraction));
    minutes += lit.back().minutes;
  }
  if (minutes == 0) suns.lost_wh_m2 += hour.direct_wh_m2;
  for (const Lit& part : lit) {
    if (part.minutes == 0) {
      ++suns.below;
      continue;
    }
    const Position at = position(weather.place, part.middle_s, times.refraction);
    add_sun({direction(at, times.north_deg), part.minutes, part.middle_s,
             static_cast<int>(static_cast<unsigned>(hour.day.month())) - 1,
             hour.direct_wh_m2 * part.minutes / minutes},
            suns);
  }
}

}  // namespace

Expected<Suns> suns_of(const SunTimes& times) {
  constexpr double day_min = 24 * 60;
  const int steps = std::max(1, static_cast<int>(std::lround(day_min / times.step_min)));
  const int days = static_cast<int>((times.days.last - times.days.first).count()) + 1;
  const std::size_t runs = static_cast<std::size_t>((days + times.days.every - 1) / times.days.every);
  if (runs * static_cast<std::size_t>(steps) > most_suns)
    return base::fail(
        "found {} days of {} steps, expected at most {} in all; a longer --step or every Nth of the --days "
        "takes fewer",
        runs, steps, most_suns);
  Suns suns{{}, SunKind::minutes, times.zone_min};
  for (int first = 0; first < days; first += times.days.every) {
    const int length = std::min(times.days.every, days - first);
    const Day day = times.days.first + std::chrono::days(first + (length - 1) / 2);
    const double begin_s =
        86400.0 * static_cast<double>(day.time_since_epoch().count()) - 60.0 * times.zone_min;
    for (int step = 0; step < steps; ++step) {
      const double utc_s = begin_s + 86400.0 * (step + 0.5) / steps;
      const Position place = position(times.place, utc_s, times.refraction);
      add_sun({direction(place, times.north_deg), day_min * length / steps, utc_s,
               month_of(utc_s, times.zone_min)},
              suns);
    }
  }
  return suns;
}

Expected<Suns> suns_of(const Weather& weather, const WeatherTimes& times) {
  const int steps = std::max(1, static_cast<int>(std::lround(60 / times.step_min)));
  Suns suns{{}, SunKind::radiation, weather.zone_min};
  for (const WeatherHour& hour : weather.hours) {
    if (times.days && !times.days->holds(hour.day)) continue;
    add_hour(weather, hour, times, steps, suns);
    suns.diffuse_wh_m2[hour.day] += hour.diffuse_wh_m2;
    if (suns.list.size() > most_suns)
      return base::fail(
          "found more than {} suns, expected fewer; a longer --step or fewer --days takes fewer", most_suns);
  }
  return suns;
}

Expected<Suns> read_suns(const std::filesystem::path& file, const FileFrame& frame, double north_deg) {
  constexpr std::array<std::string_view, 6> names{"x", "y", "z", "azimuth", "altitude", "weight"};
  const auto columns = read_columns(file, names);
  if (!columns) return tl::unexpected(columns.error());
  const auto& v = columns->values;
  const bool axes = columns->has(0) && columns->has(1) && columns->has(2);
  if (!axes && !(columns->has(3) && columns->has(4)))
    return base::fail("{}: found no columns x, y, z and none azimuth, altitude, expected one of both",
                      file.string());
  if (columns->rows > most_suns)
    return base::fail("{}: found {} suns, expected at most {}", file.string(), columns->rows, most_suns);
  Suns suns;
  for (std::size_t i = 0; i < columns->rows; ++i) {
    const double weight = columns->has(5) ? v[5][i] : 1;
    const glm::dvec3 given = axes ? frame.direction_to_scene({v[0][i], v[1][i], v[2][i]})
                                  : direction({v[3][i], v[4][i]}, north_deg);
    const double length = glm::length(given);
    if (!(length > 0) || !std::isfinite(length))
      return base::fail("{}: sun {} has no direction, expected x, y, z that are not all 0", file.string(),
                        i + 1);
    constexpr double most_weight = 1e30;  // sums of all suns stay finite
    if (!(weight >= 0 && weight <= most_weight))
      return base::fail("{}: sun {} has the weight {}, expected 0 to {}", file.string(), i + 1, weight,
                        most_weight);
    if (!axes && std::abs(v[4][i]) > 90)
      return base::fail("{}: sun {} has the altitude {}, expected -90 to 90 degrees", file.string(), i + 1,
                        v[4][i]);
    add_sun({given / length, weight, 0, 0}, suns);
  }
  return suns;
}

}  // namespace tenebra::sun
