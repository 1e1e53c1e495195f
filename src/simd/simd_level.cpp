#include <tenebra/simd_level.h>

#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <utility>

namespace tenebra {

namespace {

constexpr std::array<std::pair<SimdLevel, std::string_view>, 5> names = {{
    {SimdLevel::automatic, "auto"},
    {SimdLevel::scalar, "scalar"},
    {SimdLevel::sse4, "sse4"},
    {SimdLevel::avx2, "avx2"},
    {SimdLevel::avx512, "avx512"},
}};

}  // namespace

std::string_view simd_level_name(SimdLevel level) {
  for (const auto& [candidate, name] : names) {
    if (candidate == level) return name;
  }
  return {};
}

std::optional<SimdLevel> simd_level_from_name(std::string_view name) {
  for (const auto& [level, candidate] : names) {
    if (candidate == name) return level;
  }
  return std::nullopt;
}

bool simd_level_supported(SimdLevel level) {
  // Asked once: the answer needs instructions that cost tens of microseconds in a virtual machine.
  static const std::int64_t supported = HWY_TARGETS & hwy::SupportedTargets();
  const auto has = [](std::int64_t target) { return (supported & target) != 0; };
  switch (level) {
    case SimdLevel::avx512:
      return has(HWY_AVX3);
    case SimdLevel::avx2:
      return has(HWY_AVX2);
    case SimdLevel::sse4:
      return has(HWY_SSE4);
    default:
      return true;
  }
}

SimdLevel best_simd_level() {
  for (const SimdLevel level : {SimdLevel::avx512, SimdLevel::avx2, SimdLevel::sse4}) {
    if (simd_level_supported(level)) return level;
  }
  return SimdLevel::scalar;
}

}  // namespace tenebra
