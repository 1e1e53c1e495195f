#include "settings/text_values.h"

#include <algorithm>
#include <cmath>

#include "base/fail.h"

namespace tenebra::settings {

bool is_word(std::string_view text, std::string_view word) {
  return lower_case(text) == lower_case(word);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(separator, at);
    parts.push_back(text.substr(at, next - at));
    if (next == std::string_view::npos) return parts;
    at = next + 1;
  }
}

std::optional<double> finite_from(std::string_view text) {
  return base::finite_in(text);
}

Expected<glm::dvec3> parse_place(const std::string& text) {
  const auto parts = split(text, ',');
  glm::dvec3 place(0.0);
  bool is_vector = parts.size() == 3;
  for (int i = 0; is_vector && i < 3; ++i) {
    const auto value = finite_from(parts[static_cast<std::size_t>(i)]);
    if (value) place[i] = *value;
    is_vector = value && std::isfinite(static_cast<float>(*value));
  }
  if (!is_vector) return base::fail("found {}, expected three numbers X,Y,Z, like 0,1.5,-4", text);
  return place;
}

std::string place_text(const glm::dvec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

Expected<glm::vec3> parse_vector(const std::string& text) {
  return parse_place(text).map([](const glm::dvec3& place) { return glm::vec3(place); });
}

std::string vector_text(const glm::vec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

Expected<double> parse_positive(const std::string& text) {
  const auto number = finite_from(text);
  if (!number || *number <= 0) return base::fail("found {}, expected a number above 0", text);
  return *number;
}

Expected<float> parse_factor(const std::string& text) {
  const auto factor = parse_positive(text);
  if (!factor || static_cast<float>(*factor) == 0.0f || *factor > 1e30) {
    return base::fail("found {}, expected a factor above 0, like 1.5", text);
  }
  return static_cast<float>(*factor);
}

Expected<double> parse_time(const std::string& text) {
  const auto seconds = finite_from(text);
  if (!seconds) return base::fail("found {}, expected a time in seconds, like 1.5", text);
  return *seconds;
}

Expected<int> parse_count(const std::string& text) {
  const auto count = number_from<int>(text);
  if (!count || *count < 0 || *count > largest_count) {
    return base::fail("found {}, expected a whole number from 0 to {}", text, largest_count);
  }
  return *count;
}

Expected<int> parse_at_least_one(const std::string& text) {
  const auto count = parse_count(text);
  if (!count || *count < 1)
    return base::fail("found {}, expected a whole number from 1 to {}", text, largest_count);
  return count;
}

Expected<LightSize> parse_light_size(const std::string& text) {
  LightSize result;
  std::string_view sizes = text;
  result.percent = sizes.ends_with('%');
  if (result.percent) sizes.remove_suffix(1);
  const auto parts = split(sizes, 'x');
  const auto side = [&](std::size_t i) { return static_cast<float>(finite_from(parts[i]).value_or(0)); };
  result.size = {side(0), side(parts.size() - 1)};
  const auto is_zero = [](std::string_view side) { return finite_from(side) == 0; };
  const bool none = std::all_of(parts.begin(), parts.end(), is_zero);
  const bool usable =
      none || (result.size.x > 0 && result.size.y > 0 && std::isfinite(result.size.x + result.size.y));
  if (parts.size() > 2 || !usable) {
    return base::fail(
        "found {}, expected W or WxH above 0, in metres or with % of the scene's diagonal, like 0.5, 1x0.4 "
        "or 4%, or 0 for none",
        text);
  }
  return result;
}

Expected<float> parse_sun_size(const std::string& text) {
  const double degrees = finite_from(text).value_or(-1);
  if (!(degrees >= 0 && degrees <= 90))
    return base::fail("found {}, expected degrees from 0 to 90, like 0.53", text);
  return static_cast<float>(degrees);
}

}  // namespace tenebra::settings
