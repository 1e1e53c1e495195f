// Contestants on the same rays, timed so that other load of the machine affects all alike.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/ao/ao_rays.h"

namespace tenebra::bench {

/// The cost of work: on one thread the processor time of the process, to which other programs add nothing; on
/// more threads wall-clock time. Runs from its construction.
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
double trace_ms(std::span<const trees::RayBatch> batches, const Tracer& tracer);

struct Racer {
  std::string name;
  Tracer tracer;
  double ms = 0;  ///< for all rays
};

/// Cuts the rays into slices of less than a scheduler's; all racers take a slice in turn, then the next, and
/// all of it `rounds` times (and once before to warm up). A racer's time is the sum of the slices' medians.
/// On the threads that the caller allows.
void race(std::span<Racer> racers, std::span<const trees::RayBatch> rays, int rounds);

}  // namespace tenebra::bench
