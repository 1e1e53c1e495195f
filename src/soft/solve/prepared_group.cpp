#include "soft/solve/prepared_group.h"

#include <numeric>

#include "soft/occluders/quads.h"

namespace tenebra::soft {

void take_all(const GroupCandidates& candidates, std::vector<std::uint32_t>& places) {
  places.resize(candidates.all.size());
  std::iota(places.begin(), places.end(), 0u);
}

PreparedGroup GroupPreparer::prepare(const SoftFrame& frame, const GroupTask& task) {
  return {task.frame, candidates_, silhouette_, sort_out(frame, task.frame, task.candidates)};
}

std::size_t GroupPreparer::begin_family(std::span<const GroupTask> tasks) {
  family_.clear();
  for (const GroupTask& task : tasks) family_.add(task.candidates);
  return family_.triangles().size();
}

bool GroupPreparer::prepare_family(const SoftFrame& frame, const GroupFrame& around) {
  const auto clipped = sort_out(frame, around, family_.triangles());
  if (!silhouette_.empty() || stop_requested(frame.stop)) return false;
  family_.make_ready(candidates_, clipped);
  return true;
}

PreparedGroup GroupPreparer::choose(std::size_t k, const GroupTask& task, const StopFlag* stop) {
  return {task.frame, candidates_, silhouette_, family_.choose(k, task.frame, candidates_, stop)};
}

/// Returns the candidates to be clipped; none, if a stop is requested. The BSP takes the candidates unsorted.
std::span<const std::uint32_t> GroupPreparer::sort_out(const SoftFrame& frame, const GroupFrame& group,
                                                       std::span<const std::uint32_t> triangles) {
  silhouette_.clear();
  candidates_.all.reserve(triangles.size());
  find_candidates_(frame.light, frame.triangles, group, triangles, candidates_, frame.stop);
  if (frame.config.solver == SoftSolver::bsp || stop_requested(frame.stop)) return {};
  if (frame.config.solver == SoftSolver::automatic) {
    finder_.find(frame.light, frame.triangles, candidates_, silhouette_, rest_, frame.stop);
    if (stop_requested(frame.stop)) return {};
    drop_beside_light(group, candidates_.axes, silhouette_);
    pair_triangles(group, candidates_, rest_);
  } else {
    take_all(candidates_, rest_);
  }
  if (stop_requested(frame.stop)) return {};
  return order_.sorted(candidates_, rest_);
}

}  // namespace tenebra::soft
