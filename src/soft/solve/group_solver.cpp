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

GroupSolver::GroupSolver(SimdLevel level, const SolverMakers& makers, MemoryPool* pool)
    : level_(level), makers_(makers), memory_(pool), preparer_(level), lit_(make_lit_solver(level)) {}

void GroupSolver::release() {
  preparer_ = GroupPreparer(level_);
  for (std::unique_ptr<Solver>* solver : {&points_, &packets_, &bsp_}) solver->reset();
  memory_.release();
}

bool GroupSolver::solve(const SoftFrame& frame, const GroupTask& task) {
  const SoftStats before = stats;
  memory_.begin_group();
  base::Stopwatch watch;
  if (memory_.add_candidates(task.candidates.size() * sizeof(Candidate)))
    solve_prepared(frame, preparer_.prepare(frame, task), task.pixels, watch);
  if (memory_.refused()) stats = before;
  return !memory_.refused();
}

bool GroupSolver::solve_together(const SoftFrame& frame, const GroupFrame& around,
                                 std::span<const GroupTask> tasks) {
  const SoftStats before = stats;
  memory_.begin_group();
  if (memory_.add_candidates(preparer_.begin_family(tasks) * sizeof(Candidate)))
    solve_family(frame, around, tasks);
  if (memory_.refused()) stats = before;
  return !memory_.refused();
}

void GroupSolver::solve_family(const SoftFrame& frame, const GroupFrame& around,
                               std::span<const GroupTask> tasks) {
  base::Stopwatch watch;
  const bool together = preparer_.prepare_family(frame, around);
  times.init_ms += watch.lap_ms();
  const std::size_t of_all = memory_.group_bytes();
  for (std::size_t k = 0; k < tasks.size() && !stop_requested(frame.stop) && !memory_.refused(); ++k) {
    if (!together) {
      solve(frame, tasks[k]);
      continue;
    }
    memory_.back_to(of_all);
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
void GroupSolver::solve_prepared(const SoftFrame& frame, PreparedGroup group,
                                 std::span<const std::uint32_t> pixels, base::Stopwatch& watch) {
  if (stop_requested(frame.stop)) return;  // it may not be whole
  Solver& solver = solver_of(frame, group);
  if (!memory_.add_candidates(preparer_.bytes() + solver.bytes_for(group))) return;
  group.memory = &memory_;
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
