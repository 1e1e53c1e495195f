// Which vector instructions to use. The time depends on it; the results do not.
#pragma once

#include <optional>
#include <string_view>

namespace tenebra {

/// Higher levels have wider vectors. A level can be used where the build and the machine have it.
enum class SimdLevel { automatic, scalar, sse4, avx2, avx512 };  ///< ARM has sse4 alone: NEON, "neon"
std::string_view simd_level_name(SimdLevel level);               ///< "avx2"
/// The level of that name; none if there is no such level.
std::optional<SimdLevel> simd_level_from_name(std::string_view name);
bool simd_level_supported(SimdLevel level);  ///< by this build on this machine
SimdLevel best_simd_level();                 ///< what `automatic` means here

}  // namespace tenebra
