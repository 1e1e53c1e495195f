#include "settings/values.h"

#include <cstdint>
#include <cstdlib>

#include "base/fail.h"

namespace tenebra::settings {
namespace {

constexpr double half_turn_deg = 180.0;

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

Expected<double> parse_field_of_view(const std::string& text) {
  const auto degrees = finite_from(text);
  if (!degrees || *degrees <= 0 || *degrees >= half_turn_deg) {
    return base::fail("found {}, expected degrees above 0 and below 180", text);
  }
  return *degrees;
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

}  // namespace tenebra::settings
