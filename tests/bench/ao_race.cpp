#include "ao_race.h"

#include <algorithm>

#include "bench_report.h"
#include "parallel/parallel.h"

namespace tenebra::bench {

void race(std::span<Racer> racers, std::span<const RayBatch> rays, int rounds) {
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
