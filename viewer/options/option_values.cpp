#include "options/option_values.h"

#include "base/fail.h"
#include "options/choices.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace tenebra::viewer {
namespace {

constexpr int largest_count = 1'000'000;
constexpr double half_turn_deg = 180.0;

/// The whole of `text` as a number; std::from_chars uses no locale and takes no leading space.
template <class Number>
std::optional<Number> number_from(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return number;
}

std::optional<double> finite_from(std::string_view text) {
  const auto number = number_from<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
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

std::optional<int> frame_from(std::string_view text) {
  const auto frame = number_from<int>(text);
  return frame && *frame >= 0 ? frame : std::nullopt;
}

}  // namespace

Expected<Size> parse_size(const std::string& text) {
  const auto parts = split(text, 'x');
  const auto side = [&](std::size_t i) {
    const auto value = number_from<int>(parts[i]);
    return value && *value >= 1 && *value <= largest_side_px ? *value : 0;
  };
  if (parts.size() != 2 || side(0) == 0 || side(1) == 0) {
    return base::fail("found {}, expected WxH with 1 to {} pixels each, like 800x600", text, largest_side_px);
  }
  return Size{side(0), side(1)};
}

Expected<FrameRange> parse_frame_range(const std::string& text) {
  if (is_word(text, "all")) return FrameRange{};
  const auto parts = split(text, ':');
  const auto refuse = [&] {
    return base::fail("found {}, expected A, A:B, A:B:STEP, A: or all, like 0:99:10", text);
  };
  if (parts.size() > 3) return refuse();
  const auto first = frame_from(parts[0]);
  if (!first) return refuse();
  FrameRange range{*first, *first, 1};
  if (parts.size() > 1) {
    range.last = frame_from(parts[1]);
    if (!range.last && !parts[1].empty()) return refuse();
  }
  if (parts.size() > 2) {
    range.step = frame_from(parts[2]).value_or(0);
    if (range.step < 1) return refuse();
  }
  if (range.last && *range.last < range.first) {
    return base::fail("found {}, expected an end that is not before the start", text);
  }
  return range;
}

Expected<Chunk> parse_chunk(const std::string& text) {
  const auto parts = split(text, '/');
  const auto index = parts.size() == 2 ? frame_from(parts[0]) : std::nullopt;
  const auto count = parts.size() == 2 ? frame_from(parts[1]) : std::nullopt;
  if (!index || !count || *index < 1 || *index > *count)
    return base::fail("found {}, expected I/N with I from 1 to N, like 3/16", text);
  return Chunk{*index, *count};
}

Expected<glm::vec3> parse_vector(const std::string& text) {
  const auto parts = split(text, ',');
  glm::vec3 vector(0.0f);
  bool is_vector = parts.size() == 3;
  for (int i = 0; is_vector && i < 3; ++i) {
    const auto value = finite_from(parts[static_cast<std::size_t>(i)]);
    if (value) vector[i] = static_cast<float>(*value);
    is_vector = value && std::isfinite(vector[i]);
  }
  if (!is_vector) return base::fail("found {}, expected three numbers X,Y,Z, like 0,1.5,-4", text);
  return vector;
}

Expected<double> parse_field_of_view(const std::string& text) {
  const auto degrees = finite_from(text);
  if (!degrees || *degrees <= 0 || *degrees >= half_turn_deg) {
    return base::fail("found {}, expected degrees above 0 and below 180", text);
  }
  return *degrees;
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

Expected<int> parse_square_count(const std::string& text) {
  std::int64_t product = 1;
  const auto parts = split(text, 'x');
  for (const std::string_view part : parts) product *= number_from<int>(part).value_or(0);
  const bool whole = parts.size() <= 2 && product >= 1 && product <= largest_count;
  if (!whole || (parts.size() == 2 && parts[0].starts_with('-'))) {
    return base::fail("found {}, expected a number from 1 to {}, or one as WxH, like 1024 or 32x32", text,
                      largest_count);
  }
  return static_cast<int>(product);
}

Expected<LightSize> parse_light_size(const std::string& text) {
  LightSize result;
  std::string_view sizes = text;
  result.percent = sizes.ends_with('%');
  if (result.percent) sizes.remove_suffix(1);
  const auto parts = split(sizes, 'x');
  const auto side = [&](std::size_t i) { return static_cast<float>(finite_from(parts[i]).value_or(0)); };
  result.size = {side(0), side(parts.size() - 1)};
  const bool usable = result.size.x > 0 && result.size.y > 0 && std::isfinite(result.size.x + result.size.y);
  if (parts.size() > 2 || !usable) {
    return base::fail(
        "found {}, expected W or WxH above 0, in metres or with % of the scene's diagonal, like 0.5, 1x0.4 "
        "or 4%",
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

Expected<SimdLevel> parse_simd(const std::string& text) {
  const auto level = simd_level_from_name(lower_case(text));
  if (!level) return base::fail("found {}, expected auto, scalar, sse4, avx2, avx512 or, on ARM, neon", text);
  if (*level != SimdLevel::automatic && !simd_level_supported(*level)) {
    return base::fail("this machine or build has no {}, its best is {}", text,
                      simd_level_name(best_simd_level()));
  }
  return *level;
}

Expected<int> parse_light(const std::string& text) {
  if (is_word(text, "all")) return -1;
  const auto number = parse_count(text);
  return number ? number : base::fail("found {}, expected the number of a light, from 0, or all", text);
}

Expected<int> parse_threads(const std::string& text) {
  const auto threads = parse_count(text);
  if (!threads || *threads > 1024)
    return base::fail("found {}, expected 1 to 1024, or 0 for all cores", text);
  return threads;
}

Expected<double> parse_soft_error(const std::string& text) {
  if (text == "0") return 0.0;
  const auto error = parse_positive(text);
  if (!error || *error < 0.1 || *error > 255)
    return base::fail("found {}, expected 0 (exact), or 0.1 to 255", text);
  return error;
}

std::filesystem::path default_cache_folder() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);
    const std::filesystem::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : std::filesystem::path();
  };
  if (const auto cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache / "tenebra";
  const auto home = absolute("HOME");
  return home.empty() ? home : home / ".cache" / "tenebra";
}

}  // namespace tenebra::viewer
