#include "bench/ao/ao_race.h"

#include <time.h>

#include <algorithm>
#include <limits>

#include "bench/common/bench_report.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t at_once = 16;  // batches: a point's 256 rays

double clock_ms(bool one_thread) {
  timespec now{};
  clock_gettime(one_thread ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

CostClock::CostClock() : one_thread_(thread_count() == 1), start_ms_(clock_ms(one_thread_)) {}
double CostClock::ms() {
  return clock_ms(one_thread_) - start_ms_;
}

double cost_ms(const std::function<void()>& work) {
  CostClock clock;
  work();
  return clock.ms();
}

double trace_ms(std::span<const trees::RayBatch> batches, const Tracer& tracer) {
  CostClock clock;
  std::vector<float> kept(batches.size());
  parallel::parallel_ranges(batches.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; b += at_once) {
      const std::size_t count = std::min(at_once, last - b);
      float t[at_once * trees::batch_size];
      std::fill(t, t + count * trees::batch_size, std::numeric_limits<float>::infinity());
      tracer(batches.subspan(b, count), t);
      kept[b] = t[0];  // so that the work is needed
    }
  });
  return clock.ms();
}

void race(std::span<Racer> racers, std::span<const trees::RayBatch> rays, int rounds) {
  // One thread: 512 batches, some 0.05 ms of look-ups and 1 ms of Embree. More threads want work to share.
  const std::size_t slice = thread_count() == 1 ? 512 : 8192, slices = (rays.size() + slice - 1) / slice;
  std::vector<std::vector<double>> times(racers.size() * slices);
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t s = 0; s < slices; ++s) {
      const auto part = rays.subspan(s * slice, std::min(slice, rays.size() - s * slice));
      for (std::size_t r = 0; r < racers.size(); ++r) {
        const double ms = trace_ms(part, racers[r].tracer);
        if (round >= 0) times[r * slices + s].push_back(ms);
      }
    }
  }
  for (std::size_t r = 0; r < racers.size(); ++r) {
    racers[r].ms = 0;
    for (std::size_t s = 0; s < slices; ++s) racers[r].ms += median(times[r * slices + s]);
  }
}

}  // namespace tenebra::bench
