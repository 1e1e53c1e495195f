// The work of anti-aliasing, for results and the log.
#pragma once

#include <cstdint>

namespace tenebra::render {

struct AntialiasStats {
  std::uint64_t pixels = 0;   ///< that needed more than the sample at their centre
  std::uint64_t samples = 0;  ///< of those, beside the centres; not all are lit and shaded by themselves
};

}  // namespace tenebra::render
