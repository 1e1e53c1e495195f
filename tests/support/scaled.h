// How much the longer tests do.
#pragma once

#include <cstdlib>

namespace tenebra::testing {

/// `count` times the environment variable TENEBRA_TEST_SCALE (unset: 1).
inline int scaled(int count) {
  const char* scale = std::getenv("TENEBRA_TEST_SCALE");
  return scale == nullptr ? count : static_cast<int>(count * std::atof(scale));
}

}  // namespace tenebra::testing
