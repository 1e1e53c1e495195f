// Wall-clock time of stages.
#pragma once

#include <chrono>

namespace tenebra::base {

/// Runs from its construction.
class Stopwatch {
public:
  /// Milliseconds since the last lap, or since construction; starts the next lap.
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - lap_).count();
    lap_ = now;
    return ms;
  }

private:
  std::chrono::steady_clock::time_point lap_ = std::chrono::steady_clock::now();
};

}  // namespace tenebra::base
