#include "ao/presampled/field_pass.h"

#include <algorithm>
#include <numeric>

#include "base/fail.h"
#include "base/sort_unique.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

/// Keeps everything that the groups need in this frame.
void FieldPass::use(std::span<const GroupReport> reports) {
  std::vector<int>&own = room.own, &reached = room.reached;
  own.clear();
  for (const GroupReport& report : reports) {
    own.insert(own.end(), report.own.begin(), report.own.end());
    reached.insert(reached.end(), report.reached.begin(), report.reached.end());
  }
  base::sort_unique(own);
  base::sort_unique(reached);
  for (const int number : own) bodies.use(number);
  for (const int occluder : reached) occluders.use(occluder);
}

/// Makes what the groups lack: samples first, because bodies without them are slowest.
Expected<void> FieldPass::supply(std::span<const GroupReport> reports, const AoProgress& progress,
                                 const StopFlag* stop) {
  std::vector<int>&missing = room.occluders, &without_samples = room.bodies;
  std::vector<MissingSample>& samples = room.samples;
  missing.clear(), without_samples.clear(), samples.clear();
  for (const GroupReport& report : reports) {
    missing.insert(missing.end(), report.occluders.begin(), report.occluders.end());
    without_samples.insert(without_samples.end(), report.bodies.begin(), report.bodies.end());
    samples.insert(samples.end(), report.samples.begin(), report.samples.end());
  }
  base::sort_unique(samples);
  const std::uint64_t before = bodies.filled();
  if (auto filled = bodies.fill(samples, kernels, progress, stop); !filled) return filled;
  stats.rays_cast += (bodies.filled() - before) * SurfaceRays::rays;
  base::sort_unique(without_samples);
  bodies.make(without_samples, casters, stop);
  if (stop_requested(stop)) return base::stopped();
  base::sort_unique(missing);
  return occluders.build(missing, progress);
}

Expected<void> FieldPass::run(const ReceiverSet& set, AoPart part, std::vector<float>& values,
                              const AoProgress& progress, const StopFlag* stop) {
  values.assign(set.values(), 1.0f);
  std::vector<int>& pending = room.pending;
  pending.resize(static_cast<std::size_t>(set.groups()));
  std::iota(pending.begin(), pending.end(), 0);
  room.shaders.resize(std::max(room.shaders.size(), static_cast<std::size_t>(thread_count())));
  for (GroupShader& shader : room.shaders) shader.begin(occluders, bodies, rays, kernels);
  if (room.reports.size() < pending.size()) room.reports.resize(pending.size());
  room.reached.clear();
  base::Stopwatch watch;
  constexpr int most_rounds = 8;  // bodies and occluders, three levels of samples, a cell and its samples
  for (int round = 0; !pending.empty(); ++round) {
    if (round == most_rounds)
      return base::fail(
          "ambient occlusion: the fields or samples that {} groups of points need cannot be made",
          pending.size());
    const auto reports = std::span(room.reports).first(pending.size());
    for (GroupReport& report : reports) report.clear();
    parallel::parallel_tasks(static_cast<int>(pending.size()), [&](int i) {
      if (stop_requested(stop)) return;
      const auto at = static_cast<std::size_t>(i);
      room.shaders[static_cast<std::size_t>(parallel::thread_index())].shade(set, part, pending[at], values,
                                                                             reports[at]);
    });
    watch.lap_ms();
    if (stop_requested(stop)) return base::stopped();
    room.left.clear();
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const GroupReport& report = reports[i];
      if (!report.complete()) room.left.push_back(pending[i]);
      stats.points += report.points;
      stats.lookups += report.counts.lookups;
      stats.rays_cast += report.counts.rays_cast;
    }
    use(reports);
    pending.swap(room.left);
    if (!pending.empty()) {
      if (auto supplied = supply(reports, progress, stop); !supplied) return supplied;
    }
    timings.ao_build_ms += watch.lap_ms();
  }
  stats.objects += static_cast<std::uint64_t>(std::count_if(
      room.reached.begin(), room.reached.end(), [&](int occluder) { return casters.is_object(occluder); }));
  return {};
}

}  // namespace tenebra::ao
