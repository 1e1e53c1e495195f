// What GoogleTest and CTest call parameters of tests by: a word, not bytes.
#pragma once

#include <ostream>

#include <tenebra/ao_config.h>
#include <tenebra/simd_level.h>

namespace tenebra {

inline void PrintTo(SimdLevel level, std::ostream* out) {
  *out << simd_level_name(level);
}

inline void PrintTo(AoMode mode, std::ostream* out) {
  constexpr const char* names[] = {"none", "adaptive", "field", "rays"};
  *out << names[static_cast<int>(mode)];
}

}  // namespace tenebra
