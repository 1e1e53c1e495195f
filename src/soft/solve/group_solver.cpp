#include "soft/solve/group_solver.h"

#include <algorithm>

#include "simd/prefetch.h"
#include "soft/clip/packet_limits.h"
#include "soft/groups/point_groups.h"

namespace tenebra::soft {

namespace {

Solver& made(std::unique_ptr<Solver>& solver, SolverMakers::Make make, SimdLevel level) {
  if (!solver) solver = make(level);
  return *solver;
}

/// Silhouettes gain nothing from packets: their edges fill the lanes.
bool wants_packets(const SoftFrame& frame, const PreparedGroup& group) {
  return frame.config.solver == SoftSolver::automatic && group.silhouette.empty() &&
         group.clipped.size() <= most_packet_occluders &&
         frame.light.polygon.size() <= most_packet_light_vertices;
}

SoftClass class_of(const SoftFrame& frame, const PreparedGroup& group) {
  if (frame.config.solver == SoftSolver::bsp) return SoftClass::bsp;
  return group.silhouette.empty() ? SoftClass::clip : SoftClass::silhouette;
}

}  // namespace

GroupSolver::GroupSolver(SimdLevel level, const SolverMakers& makers, MemoryBound* memory)
    : level_(level), makers_(makers), memory_(memory), preparer_(level), lit_(make_lit_solver(level)) {}

void GroupSolver::release() {
  preparer_ = GroupPreparer(level_);
  for (std::unique_ptr<Solver>* solver : {&points_, &packets_, &bsp_}) solver->reset();
}

template <class Solve>
void GroupSolver::within_memory(std::size_t bytes, const Solve& solve) {
  if (memory_ == nullptr) return solve();
  memory_->run(bytes, solve, [this] { release(); });
}

void GroupSolver::solve(const SoftFrame& frame, const GroupTask& task) {
  const std::size_t candidates = bytes_of_candidates(frame.config.solver, task.candidates.size());
  std::size_t tree = 0;
  if (frame.config.solver == SoftSolver::bsp) tree = std::min(frame.config.tree_bytes, largest_tree_bytes);
  if (memory_ != nullptr) tree = std::min(tree, largest_tree(*memory_, candidates));
  within_memory(candidates + bytes_of_tree * tree, [&] { solve_group(frame, task, tree); });
}

void GroupSolver::solve_group(const SoftFrame& frame, const GroupTask& task, std::size_t tree_bytes) {
  base::Stopwatch watch;
  PreparedGroup group = preparer_.prepare(frame, task);
  group.tree_bytes = tree_bytes;
  solve_prepared(frame, group, task.pixels, watch);
}

void GroupSolver::solve_together(const SoftFrame& frame, const GroupFrame& around,
                                 std::span<const GroupTask> tasks) {
  const std::size_t candidates = preparer_.begin_family(tasks);
  within_memory(bytes_of_candidates(frame.config.solver, candidates),
                [&] { solve_family(frame, around, tasks); });
}

void GroupSolver::solve_family(const SoftFrame& frame, const GroupFrame& around,
                               std::span<const GroupTask> tasks) {
  base::Stopwatch watch;
  const bool together = preparer_.prepare_family(frame, around);
  times.init_ms += watch.lap_ms();
  for (std::size_t k = 0; k < tasks.size() && !stop_requested(frame.stop); ++k) {
    if (!together) {
      solve_group(frame, tasks[k], 0);
      continue;
    }
    solve_prepared(frame, preparer_.choose(k, tasks[k], frame.stop), tasks[k].pixels, watch);
    preparer_.restore();
  }
}

void GroupSolver::solve_lit(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups) {
  base::Stopwatch watch;
  PixelWriter writer(frame, SoftClass::clip, stats);
  lit_->solve(frame, groups, writer);
  times.irradiance_ms += watch.lap_ms();
}

void GroupSolver::expect(const SoftFrame& frame, std::span<const std::uint32_t> pixels,
                         std::span<const std::uint32_t> after) {
  constexpr std::size_t most = largest_neighbourhood;
  for (std::size_t i = 0; i < std::min(after.size(), most); i += 16) simd::prefetch(&after[i]);
  for (std::size_t i = 0; i < std::min(pixels.size(), most); i += 2) {  // in Z order two of a row at a time
    const std::uint32_t pixel = pixels[i];
    simd::prefetch(&frame.points.positions[pixel]);
    simd::prefetch(&frame.points.triangles[pixel]);
    if (!frame.normals.empty()) simd::prefetch(&frame.normals[pixel]);
  }
}

/// `watch` was started with the preparation.
void GroupSolver::solve_prepared(const SoftFrame& frame, const PreparedGroup& group,
                                 std::span<const std::uint32_t> pixels, base::Stopwatch& watch) {
  if (stop_requested(frame.stop)) return;  // it may not be whole
  Solver& solver = solver_of(frame, group);
  solver.begin(frame, group);
  times.init_ms += watch.lap_ms();
  PixelWriter writer(frame, class_of(frame, group), stats);
  solver.solve(frame, group, pixels, writer);
  times.query_ms += watch.lap_ms();
}

/// Clipping was faster than the BSP on every frame measured (1.0 to 2 times): the BSP is used only if asked
/// for by name.
Solver& GroupSolver::solver_of(const SoftFrame& frame, const PreparedGroup& group) {
  if (frame.config.solver == SoftSolver::bsp) return made(bsp_, makers_.bsp, level_);
  if (makers_.packets != nullptr && wants_packets(frame, group))
    return made(packets_, makers_.packets, level_);
  return made(points_, makers_.points, level_);
}

}  // namespace tenebra::soft
