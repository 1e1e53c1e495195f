#include <tenebra/simd_level.h>

#include <hwy/highway.h>

#include <cstdint>

#include "base/names.h"

namespace tenebra {

namespace {

#if HWY_ARCH_ARM_A64
constexpr const char* name_of_128_bits = "neon";
constexpr std::int64_t targets_of_128_bits = HWY_NEON;
constexpr bool has_scalar = false;  // nothing below NEON is compiled
#else
constexpr const char* name_of_128_bits = "sse4";
constexpr std::int64_t targets_of_128_bits = HWY_SSE4;
constexpr bool has_scalar = true;  // Highway's baseline: no vectors in 1.0.3, SSE2 in 1.2
#endif

constexpr base::Names<SimdLevel, 5> names = {{
    {SimdLevel::automatic, "auto"},
    {SimdLevel::scalar, "scalar"},
    {SimdLevel::sse4, name_of_128_bits},
    {SimdLevel::avx2, "avx2"},
    {SimdLevel::avx512, "avx512"},
}};

}  // namespace

std::string_view simd_level_name(SimdLevel level) {
  return base::name_in(names, level);
}

std::optional<SimdLevel> simd_level_from_name(std::string_view name) {
  return base::value_in(names, name);
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
      return has(targets_of_128_bits);
    case SimdLevel::scalar:
      return has_scalar;
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
