#include "bench/hard/hard_whole.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/ao/ao_race.h"
#include "bench/hard/hard_opponent.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t finalists = 2;
constexpr double near_first = 1.3;  // times the least time: what is within it is tried again

/// A tree with one way to use it.
struct Entrant {
  TreeKind kind = TreeKind::rebuild;
  PacketPlan plan{};
  double least_build_ms = 0, least_ms = 0;  // of the tries
  std::vector<double> build_ms{}, ms{};

  double median_ms() const { return median(ms); }
  std::string name() const { return fmt::format("{}, {}", tree_name(kind), packet_plan_name(plan)); }
};

class Contest {
public:
  explicit Contest(const WholeTask& task)
      : task_(task),
        before_(triangle_view(task.view.before)),
        now_(task.view.frame.triangles()),
        masks_(task.lights.size()),
        tracer_masks_(task.lights.size()) {}

  WholeResult run();

private:
  struct Tree {
    Tree(const WholeTask& task, TreeKind kind, std::span<const glm::vec3> first)
        : vertices(first),
          embree(vertices.data(), task.view.frame.triangles(),
                 moved_vertices(task.view.before.positions, task.view.frame.geometry.positions),
                 {kind, task.threads, task.simd, true}) {}
    TreeVertices vertices;
    EmbreeTree embree;
  };

  Tree& tree(TreeKind kind) {
    auto& made = trees_[static_cast<std::size_t>(kind)];
    const bool still =
        std::find(std::begin(still_trees), std::end(still_trees), kind) != std::end(still_trees);
    if (!made) made = std::make_unique<Tree>(task_, kind, still ? now_.positions : before_.positions);
    return *made;
  }
  double trace(Tree& by, const PacketPlan& plan) {
    const BenchFrame& f = task_.view.frame;
    const MaskTask masks{f.points.triangles, f.points.width, f.points.height, f.view, now_,
                         task_.lights,       f.diagonal_m,   task_.simd};
    return cost_ms([&] { trace_masks(masks, by.embree, plan, masks_); });
  }
  /// What building or refitting takes as the frame before becomes this one.
  double move(Tree& by) {
    by.vertices.put(before_.positions);
    by.embree.follow();
    by.vertices.put(now_.positions);
    return cost_ms([&] { by.embree.follow(); });
  }
  std::vector<Entrant> choose(std::span<const TreeKind> kinds, bool moved);
  void round(std::vector<Entrant>& entrants, bool moved);
  /// The tiles of this frame's ids on `triangles`, and the masks.
  double trace_ours(TriangleView triangles, std::uint64_t version) {
    const BenchFrame& f = task_.view.frame;
    triangles.version = version;
    const double tiles = cost_ms([&] {
      compute_visible_points(f.points.triangles, f.points.width, f.points.height, f.view, triangles, points_,
                             PointLayout::tiles);
    });
    tiles_ms_.push_back(tiles);
    return tiles + cost_ms([&] {
             for (std::size_t i = 0; i < task_.lights.size(); ++i)
               tracer_.trace_shadow_mask(points_, triangles, task_.lights[i], {.simd = task_.simd},
                                         tracer_masks_[i]);
           });
  }
  void round_ours();
  static WholeTimes best(const std::vector<Entrant>& entrants, const std::vector<double>& ours);

  const WholeTask& task_;
  const TriangleView before_, now_;
  std::unique_ptr<Tree> trees_[6];
  std::vector<ShadowMask> masks_, tracer_masks_;
  ShadowTracer tracer_;
  VisiblePoints points_;
  std::uint64_t version_ = 0;
  std::vector<double> ours_moved_, ours_still_, tiles_ms_;
};

/// The fastest (`finalists`) of all trees and packets: all are tried once, those near the fastest once more.
std::vector<Entrant> Contest::choose(std::span<const TreeKind> kinds, bool moved) {
  const auto faster = [](const Entrant& a, const Entrant& b) { return a.least_ms < b.least_ms; };
  std::vector<Entrant> all;
  for (const TreeKind kind : kinds) {
    double build = 0;
    for (int i = 0; moved && i < 2; ++i) {
      const double ms = move(tree(kind));
      build = i == 0 ? ms : std::min(build, ms);
    }
    trace(tree(kind), {});  // warms up
    for (const PacketPlan& plan : packet_plans(tree(kind).embree))
      all.push_back({kind, plan, build, build + trace(tree(kind), plan)});
  }
  const double near = near_first * std::min_element(all.begin(), all.end(), faster)->least_ms;
  std::erase_if(all, [&](const Entrant& entrant) { return entrant.least_ms > near; });
  for (Entrant& entrant : all) {
    const double ms = entrant.least_build_ms + trace(tree(entrant.kind), entrant.plan);
    entrant.least_ms = std::min(entrant.least_ms, ms);
  }
  std::sort(all.begin(), all.end(), faster);
  all.resize(std::min(all.size(), finalists));
  return all;
}

void Contest::round(std::vector<Entrant>& entrants, bool moved) {
  for (Entrant& entrant : entrants) {
    const double build = moved ? move(tree(entrant.kind)) : 0;
    entrant.build_ms.push_back(build);
    entrant.ms.push_back(build + trace(tree(entrant.kind), entrant.plan));
  }
}

void Contest::round_ours() {
  trace_ours(before_, ++version_);
  ours_moved_.push_back(trace_ours(now_, ++version_));
  // The caller's word that nothing moved: what an application gives that knows its scene.
  ours_still_.push_back(trace_ours(now_, version_));
}

WholeTimes Contest::best(const std::vector<Entrant>& entrants, const std::vector<double>& ours) {
  const auto fastest =
      std::min_element(entrants.begin(), entrants.end(),
                       [](const Entrant& a, const Entrant& b) { return a.median_ms() < b.median_ms(); });
  return {median(ours), fastest->median_ms(), median(fastest->build_ms), fastest->name()};
}

WholeResult Contest::run() {
  std::vector<Entrant> moving = choose(moving_trees, true), still = choose(still_trees, false);
  round_ours();
  ours_moved_.clear(), ours_still_.clear(), tiles_ms_.clear();
  for (int i = 0; i < task_.rounds; ++i) {
    round_ours();
    round(moving, true);
    round(still, false);
  }
  WholeResult result{best(moving, ours_moved_), best(still, ours_still_)};
  result.tiles = median(tiles_ms_);
  for (std::size_t i = 0; i < masks_.size(); ++i) {
    for (std::size_t k = 0; k < masks_[i].size(); ++k) {
      result.differing += masks_[i][k] != tracer_masks_[i][k] ? 1 : 0;
      result.lit += tracer_masks_[i][k] != 0 ? 1 : 0;
      result.samples += task_.view.frame.points.triangles[k] != no_triangle ? 1 : 0;
    }
  }
  return result;
}

}  // namespace

WholeResult run_whole_contest(const WholeTask& task) {
  WholeResult result;
  with_threads(task.threads, [&] { result = Contest(task).run(); });
  return result;
}

}  // namespace tenebra::bench
