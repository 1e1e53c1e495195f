// The answers of the solvers: fractions and irradiance of pixels, which solver found them, and the counts.
#pragma once

#include <cstdint>

#include "soft/solve/soft_frame.h"

namespace tenebra::soft {

class PixelWriter {
public:
  /// `solver`: what pixels are said to be answered by.
  PixelWriter(const SoftFrame& frame, SoftClass solver, SoftStats& stats)
      : frame_(frame), solver_(solver), stats_(stats) {}

  SoftStats& stats() { return stats_; }
  void answer_by(SoftClass solver) { solver_ = solver; }

  /// `area` of the light is visible, of the `above` that is above the horizon, and sends `irradiance`.
  void write(std::uint32_t pixel, double area, double irradiance, double above);
  /// The whole light is visible. Does not call count_solver().
  void write_whole(std::uint32_t pixel, double irradiance);
  /// Counts a pixel for the solver at work.
  void count_solver(std::uint32_t pixel);

private:
  void count(std::uint32_t pixel, double area, double above);

  const SoftFrame& frame_;
  SoftClass solver_;
  SoftStats& stats_;
};

}  // namespace tenebra::soft
