// Solves groups of points: each is prepared and handed to the solver that suits it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/stopwatch.h"
#include "soft/memory/memory_bound.h"
#include "soft/solve/solvers.h"

namespace tenebra::soft {

/// Times of one thread, milliseconds.
struct SolverTimes {
  double init_ms = 0, query_ms = 0, irradiance_ms = 0;
};

/// Solves group after group with buffers of its own: each thread has one.
class GroupSolver {
public:
  /// `memory`: null: there is no bound.
  explicit GroupSolver(SimdLevel level, const SolverMakers& makers = own_solvers,
                       MemoryBound* memory = nullptr);

  /// Fills out's pixels of the group, only some of them if frame.stop was requested, none if `memory` refuses
  /// what they need. The result depends on the group alone.
  void solve(const SoftFrame& frame, const GroupTask& task);
  /// Solves groups that lie near each other, within `around`, and have many candidates: these are made ready
  /// once for all.
  void solve_together(const SoftFrame& frame, const GroupFrame& around, std::span<const GroupTask> tasks);
  /// Solves groups that nothing stands in front of.
  void solve_lit(const SoftFrame& frame, std::span<const std::span<const std::uint32_t>> groups);
  /// Prefetches the points of the group that is likely to be solved next (the first of many), and the list of
  /// those `after` it.
  static void expect(const SoftFrame& frame, std::span<const std::uint32_t> pixels,
                     std::span<const std::uint32_t> after);

  SoftStats stats;
  SolverTimes times;

private:
  template <class Solve>
  void within_memory(std::size_t bytes, const Solve& solve);
  void release();
  void solve_group(const SoftFrame& frame, const GroupTask& task, std::size_t tree_bytes);
  void solve_prepared(const SoftFrame& frame, const PreparedGroup& group,
                      std::span<const std::uint32_t> pixels, base::Stopwatch& watch);
  Solver& solver_of(const SoftFrame& frame, const PreparedGroup& group);
  void solve_family(const SoftFrame& frame, const GroupFrame& around, std::span<const GroupTask> tasks);

  SimdLevel level_;
  SolverMakers makers_;
  MemoryBound* memory_;
  GroupPreparer preparer_;
  std::unique_ptr<LitSolver> lit_;
  /// Each is made when it is first asked for.
  std::unique_ptr<Solver> points_, packets_, bsp_;
};

}  // namespace tenebra::soft
