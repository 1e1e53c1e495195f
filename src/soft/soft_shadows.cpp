#include <tenebra/soft_shadows.h>

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "base/names.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/positions.h"
#include "soft/groups/point_groups.h"
#include "soft/light/light_frame.h"
#include "soft/occluders/family_candidates.h"
#include "soft/occluders/group_frame.h"
#include "soft/sample/soft_sampler.h"
#include "soft/shafts/shafts.h"
#include "soft/solve/group_solver.h"

namespace tenebra {

namespace {

constexpr base::Names<SoftSolver, 3> solver_names = {{
    {SoftSolver::automatic, "auto"},
    {SoftSolver::bsp, "bsp"},
    {SoftSolver::clip, "clip"},
}};

/// Candidates of a group, on average, from which on those of a family are made ready together (measured).
constexpr std::size_t many_candidates = 1024;
static_assert(soft::largest_family <= soft::FamilyCandidates::most_groups);

/// The state of one thread: its solver, the groups of the current family that need it, and the groups of all
/// families that are sampled at places on the light in the end.
struct alignas(64) Worker {
  std::unique_ptr<soft::GroupSolver> solver;
  std::vector<std::span<const std::uint32_t>> lit;  ///< pixels of each
  std::vector<const soft::PointGroup*> mixed;
  std::vector<std::span<const std::uint32_t>> candidates;  ///< of each
  std::vector<std::vector<std::uint32_t>> receivers;       ///< of each
  std::vector<soft::GroupTask> tasks;
  std::vector<soft::SampledGroup> sampled;
};

std::string refusal_of(std::size_t least, std::size_t most) {
  const auto mb = [](std::size_t bytes) { return std::max(std::size_t{1}, bytes >> 20); };
  return fmt::format(
      "not enough memory for soft shadows, {} MB are allowed and points that are solved together need at "
      "least {} MB; expected a larger bound (--memory soft:MB)",
      mb(most), mb(least + (std::size_t{1} << 20) - 1));
}

}  // namespace

std::string_view soft_solver_name(SoftSolver solver) {
  return base::name_in(solver_names, solver);
}

std::optional<SoftSolver> soft_solver_from_name(std::string_view name) {
  return base::value_in(solver_names, name);
}

struct SoftShadowTracer::State {
  explicit State(const soft::SolverMakers& solvers) : makers(solvers) {}

  soft::SolverMakers makers;
  bool at_work = false;     ///< or was when memory ran out: lists may not be whole
  VisiblePoints positions;  ///< where the given points have none
  soft::PointGrouper grouper;
  soft::PointGroups groups;
  soft::ShaftCuller culler;
  soft::MemoryBound memory;
  std::optional<std::size_t> memory_bytes;  ///< of the workers
  std::vector<Worker> workers;
  soft::SoftSampler sampler;
  SimdLevel level = SimdLevel::automatic;
  std::vector<std::uint8_t> classes;
  std::vector<float> errors;
  std::vector<soft::SampledGroup> sampled;  ///< of all threads
  std::vector<std::uint32_t> left;          ///< groups that sampling leaves
  std::string refusal;
  SoftStats stats;
  FrameTimings timings;

  void prepare(const SoftShadowConfig& config);
  void clear_pixels(const VisiblePoints& points, SoftMask& out);
  void solve_family(const soft::SoftFrame& frame, std::span<const soft::GroupDecision> family,
                    Worker& worker);
  void sort_out(const soft::SoftFrame& frame, const soft::GroupDecision& decision, Worker& worker);
  void solve_mixed(const soft::SoftFrame& frame, Worker& worker);
  bool refused(const SoftShadowConfig& config);
  bool sample(const soft::SoftFrame& frame, const AreaLight& light, std::span<const float> shown);
  bool solve_left(const soft::SoftFrame& frame, const TriangleView& triangles, const AreaLight& light);
  double threads_at_work() const { return workers.empty() ? 1 : static_cast<double>(workers.size()); }
  void gather();
  void count_shafts();
  bool trace(const VisiblePoints& seen, std::span<const glm::vec3> normals, const TriangleView& triangles,
             const AreaLight& light, const SoftShadowConfig& config, SoftMask& out, const StopFlag* stop,
             std::span<const float> shown);
};

void SoftShadowTracer::State::prepare(const SoftShadowConfig& config) {
  if (workers.size() != static_cast<std::size_t>(thread_count()) || level != config.simd ||
      memory_bytes != config.memory_bytes) {
    workers.clear();
    workers.resize(static_cast<std::size_t>(thread_count()));
    level = config.simd;
    memory_bytes = config.memory_bytes;
  }
  memory.begin(config.memory_bytes, workers.size());
  refusal.clear();
  for (Worker& worker : workers) {
    if (!worker.solver) worker.solver = std::make_unique<soft::GroupSolver>(level, makers, &memory);
    worker.solver->stats = {};
    worker.solver->times = {};
    worker.sampled.clear();
  }
  stats = {};
  timings = {};
}

void SoftShadowTracer::State::clear_pixels(const VisiblePoints& points, SoftMask& out) {
  const std::size_t pixels = points.triangles.size();
  out.visible_fraction.resize(pixels);
  out.irradiance.resize(pixels);
  classes.resize(pixels);
  parallel::parallel_ranges(pixels, 1 << 16, [&](std::size_t first, std::size_t last) {
    std::fill(&out.visible_fraction[first], &out.visible_fraction[0] + last, 0.0f);
    std::fill(&out.irradiance[first], &out.irradiance[0] + last, 0.0f);
    for (std::size_t i = first; i < last; ++i)
      classes[i] = static_cast<std::uint8_t>(points.triangles[i] == no_triangle ? SoftClass::background
                                                                                : SoftClass::below_horizon);
  });
}

void SoftShadowTracer::State::solve_family(const soft::SoftFrame& frame,
                                           std::span<const soft::GroupDecision> family, Worker& worker) {
  worker.lit.clear(), worker.mixed.clear(), worker.candidates.clear();
  const std::size_t first_sampled = worker.sampled.size();
  for (const soft::GroupDecision& decision : family) sort_out(frame, decision, worker);
  if (!worker.lit.empty()) worker.solver->solve_lit(frame, worker.lit);
  if (!worker.mixed.empty()) solve_mixed(frame, worker);
  if (worker.sampled.size() == first_sampled) return;
  worker.lit.clear();
  for (std::size_t i = first_sampled; i < worker.sampled.size(); ++i)
    worker.lit.push_back(worker.sampled[i].pixels);
  const SoftStats solved = worker.solver->stats;
  worker.solver->solve_lit(frame, worker.lit);  // as if nothing hid the light
  worker.solver->stats = solved;
}

void SoftShadowTracer::State::sort_out(const soft::SoftFrame& frame, const soft::GroupDecision& decision,
                                       Worker& worker) {
  const soft::PointGroup& group = *decision.group;
  const auto pixels = groups.pixels_of(group);
  const auto number = static_cast<std::uint32_t>(&group - groups.groups.data());
  const auto behind = static_cast<std::size_t>(groups.groups.data() + groups.groups.size() - &group);
  soft::GroupSolver::expect(frame, groups.pixels_of(behind > 1 ? *(&group + 1) : group),
                            groups.pixels_of(behind > 2 ? *(&group + 2) : group));
  if (decision.kind == soft::GroupClass::dark) {
    for (const std::uint32_t pixel : pixels) classes[pixel] = static_cast<std::uint8_t>(SoftClass::dark);
    worker.solver->stats.points_dark += pixels.size();
  } else if (decision.kind == soft::GroupClass::lit) {
    worker.lit.push_back(pixels);
  } else if (const soft::CandidateCounts counts{static_cast<std::uint32_t>(decision.candidates.size()),
                                                decision.from_middle};
             frame.config.error_255 > 0 &&
             soft::worth_sampling(counts, soft::first_places(frame.config.error_255))) {
    worker.solver->stats.candidates += decision.candidates.size();
    worker.sampled.push_back({number, counts, pixels});
  } else {
    worker.solver->stats.candidates += decision.candidates.size();
    worker.mixed.push_back(&group);
    worker.candidates.push_back(decision.candidates);
  }
}

void SoftShadowTracer::State::solve_mixed(const soft::SoftFrame& frame, Worker& worker) {
  const std::size_t count = worker.mixed.size();
  if (worker.receivers.size() < count + 1) worker.receivers.resize(count + 1);
  std::size_t candidates = 0;
  worker.tasks.clear();
  for (std::size_t i = 0; i < count; ++i) {
    worker.tasks.push_back({groups.pixels_of(*worker.mixed[i]),
                            soft::frame_of({&worker.mixed[i], 1}, groups, worker.receivers[i]),
                            worker.candidates[i]});
    candidates += worker.candidates[i].size();
  }
  const bool is_dense =
      frame.config.solver == SoftSolver::automatic && count > 1 && candidates > many_candidates * count;
  if (is_dense) {
    const soft::GroupFrame around = soft::frame_of(worker.mixed, groups, worker.receivers[count]);
    return worker.solver->solve_together(frame, around, worker.tasks);
  }
  for (const soft::GroupTask& task : worker.tasks) worker.solver->solve(frame, task);
}

bool SoftShadowTracer::State::refused(const SoftShadowConfig& config) {
  if (memory.least_bound() == 0) return false;
  refusal = refusal_of(memory.least_bound(), *config.memory_bytes);
  return true;
}

bool SoftShadowTracer::State::sample(const soft::SoftFrame& frame, const AreaLight& light,
                                     std::span<const float> shown) {
  sampled.clear();
  for (const Worker& worker : workers)
    sampled.insert(sampled.end(), worker.sampled.begin(), worker.sampled.end());
  std::sort(sampled.begin(), sampled.end(), [](const auto& a, const auto& b) { return a.group < b.group; });
  base::Stopwatch watch;
  const bool done = sampler.solve({frame, shown}, light, sampled, stats, left, errors);
  timings.query_ms += watch.lap_ms();
  return done;
}

/// Solves groups that sampling left alone, exactly; their candidates are found once more.
bool SoftShadowTracer::State::solve_left(const soft::SoftFrame& frame, const TriangleView& triangles,
                                         const AreaLight& light) {
  if (left.empty()) return true;
  std::sort(left.begin(), left.end());
  SoftShadowConfig config = frame.config;
  config.error_255 = 0;  // how to solve them is decided: nothing needs to be counted
  const bool done = culler.for_each_family(
      groups, triangles, light, config, frame.stop,
      [&](std::span<const soft::GroupDecision> family, int thread) {
        Worker& worker = workers[static_cast<std::size_t>(thread)];
        worker.mixed.clear(), worker.candidates.clear();
        for (const soft::GroupDecision& decision : family) {
          worker.mixed.push_back(decision.group);
          worker.candidates.push_back(decision.candidates);
        }
        solve_mixed(frame, worker);
      },
      left);
  count_shafts();
  gather();
  return done && !refused(config);
}

/// Adds up the threads' counts since the last call.
void SoftShadowTracer::State::gather() {
  const double threads = threads_at_work();
  std::uint64_t tree_bytes = 0;  // a thread holds one tree at a time
  for (Worker& worker : workers) {
    stats += worker.solver->stats;
    tree_bytes += worker.solver->stats.peak_tree_bytes;
    timings.init_ms += worker.solver->times.init_ms / threads;
    timings.query_ms += worker.solver->times.query_ms / threads;
    timings.irradiance_ms += worker.solver->times.irradiance_ms / threads;
    worker.solver->stats = {};
    worker.solver->times = {};
  }
  stats.peak_tree_bytes = std::max(stats.peak_tree_bytes, tree_bytes);
}

/// Adds the time of the last culling.
void SoftShadowTracer::State::count_shafts() {
  timings.shaft_ms += culler.stats().seconds * 1e3 / threads_at_work();
}

SoftShadowTracer::SoftShadowTracer() : SoftShadowTracer(soft::own_solvers) {}
SoftShadowTracer::SoftShadowTracer(const soft::SolverMakers& solvers)
    : state_(std::make_unique<State>(solvers)) {}
SoftShadowTracer::SoftShadowTracer(SoftShadowTracer&&) noexcept = default;
SoftShadowTracer& SoftShadowTracer::operator=(SoftShadowTracer&&) noexcept = default;
SoftShadowTracer::~SoftShadowTracer() = default;

bool SoftShadowTracer::trace(const VisiblePoints& seen, std::span<const glm::vec3> normals,
                             const TriangleView& triangles, const AreaLight& light,
                             const SoftShadowConfig& config, SoftMask& out, const StopFlag* stop,
                             std::span<const float> shown) {
  const parallel::FloatEnvironment ieee;
  if (state_->at_work) state_ = std::make_unique<State>(state_->makers);
  state_->at_work = true;
  const bool done = state_->trace(seen, normals, triangles, light, config, out, stop, shown);
  state_->at_work = false;
  return done;
}

// Mora et al. 2012, Algorithm 2, with groups of points in place of visible triangles.
bool SoftShadowTracer::State::trace(const VisiblePoints& seen, std::span<const glm::vec3> normals,
                                    const TriangleView& triangles, const AreaLight& light,
                                    const SoftShadowConfig& config, SoftMask& out, const StopFlag* stop,
                                    std::span<const float> shown) {
  const VisiblePoints& points = points::with_positions(seen, triangles, positions);
  prepare(config);
  clear_pixels(points, out);
  base::Stopwatch watch;
  grouper.group(points, triangles, light, config.grouping, groups, config.simd);
  timings.shaft_ms = watch.lap_ms();

  const soft::LightFrame frame_of_light = soft::light_frame(light);
  const soft::SoftFrame frame{points, normals, triangles, frame_of_light, config, out, classes, stop};
  const bool done = culler.for_each_family(
      groups, triangles, light, config, stop, [&](std::span<const soft::GroupDecision> family, int thread) {
        solve_family(frame, family, workers[static_cast<std::size_t>(thread)]);
      });
  count_shafts();
  gather();
  stats.groups = groups.groups.size();
  errors.clear();
  if (!done || refused(config)) return false;
  if (!(config.error_255 > 0)) return true;
  errors.assign(points.triangles.size(), 0.0f);
  if (!sample(frame, light, shown)) return false;
  if (!solve_left(frame, triangles, light)) return false;
  if (stats.points_penumbra > 0)
    stats.error_255 = std::sqrt(sampler.square_error() / static_cast<double>(stats.points_penumbra));
  return true;
}

const std::string& SoftShadowTracer::refusal() const {
  return state_->refusal;
}
const SoftStats& SoftShadowTracer::stats() const {
  return state_->stats;
}
const FrameTimings& SoftShadowTracer::timings() const {
  return state_->timings;
}
std::span<const std::uint8_t> SoftShadowTracer::classes() const {
  return state_->classes;
}
std::span<const float> SoftShadowTracer::errors() const {
  return state_->errors;
}

}  // namespace tenebra
