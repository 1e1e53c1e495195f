// Contestants on the same rays, so timed that what else the machine does meets all alike.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/ao/ao_rays.h"

namespace tenebra::bench {

/// What work costs: on one thread the processor time of the process, which other programs do not add to; on
/// more the time on the clock. Runs from its construction.
class CostClock {
public:
  CostClock();
  double ms();  ///< since construction

private:
  bool one_thread_;
  double start_ms_;
};

/// Cost of `work`.
double cost_ms(const std::function<void()>& work);

/// Cost of `tracer` for all batches.
double trace_ms(std::span<const ao::RayBatch> batches, const Tracer& tracer);

struct Racer {
  std::string name;
  Tracer tracer;
  double ms = 0;  ///< for all rays
};

/// Cuts the rays into slices of less than a scheduler's; all racers take a slice in turn, then the next, and
/// all of it `rounds` times (and once before to warm up). A racer's time is the sum of the slices' medians.
/// On the threads that the caller allows.
void race(std::span<Racer> racers, std::span<const ao::RayBatch> rays, int rounds);

}  // namespace tenebra::bench
