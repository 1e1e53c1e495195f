#include "bench/frame/frame_contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "bench/common/bench_report.h"
#include "bench/common/scene_renderer.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr int visible_step = 16;  // of 255: where pictures count as different

/// Tenebra's side of a frame, stage by stage.
Expected<TenebraFrameTimes> draw_ours(SceneRenderer& renderer, int frame) {
  base::Stopwatch watch, whole;
  renderer.evaluate(frame);
  TenebraFrameTimes times;
  times.evaluate = watch.lap_ms();
  const auto drawn = renderer.draw(renderer.settings());
  if (!drawn) return tl::unexpected(drawn.error());
  times.total = whole.lap_ms();
  const FrameTimings& t = (*drawn)->timings;
  times.raster = t.raster_ms + t.readback_ms;
  times.points = t.points_ms;
  times.shadows = t.rays_ms + t.sort_ms + t.build_ms + t.traverse_ms + t.writeback_ms;
  times.shade = t.composite_ms;
  return times;
}

constexpr int tries = 2;

/// The fastest packets on the last frame.
PacketPlan choose_plan(EmbreeRenderer& renderer) {
  PacketPlan best;
  double least = 0;
  for (int i = 0; i < tries; ++i) {
    for (const PacketPlan& plan : packet_plans(renderer.tree())) {
      const double ms = renderer.retrace(plan);
      if (least > 0 && ms >= least) continue;
      least = ms;
      best = plan;
    }
  }
  return best;
}

/// The least time of the last frame after the one before.
double try_out(EmbreeRenderer& renderer, const std::vector<int>& frames) {
  double least = 0;
  for (int i = 0; i < tries; ++i) {
    renderer.draw(frames[frames.size() - 2]);
    const double ms = renderer.draw(frames.back()).total;
    least = i == 0 ? ms : std::min(least, ms);
  }
  return least;
}

/// The best packets on the tree that is built anew, then the best tree with these.
std::unique_ptr<EmbreeRenderer> choose(const FrameTask& task, const std::vector<int>& frames) {
  auto best =
      std::make_unique<EmbreeRenderer>(task, TreeKind::rebuild, PacketPlan{}, frames.front(), frames.back());
  best->draw(frames.back());
  const PacketPlan plan = choose_plan(*best);
  best->retrace(plan);
  double least = try_out(*best, frames);
  for (const TreeKind kind : moving_trees) {
    if (kind == TreeKind::rebuild) continue;
    auto other = std::make_unique<EmbreeRenderer>(task, kind, plan, frames.front(), frames.back());
    const double ms = try_out(*other, frames);
    if (ms >= least) continue;
    least = ms;
    best = std::move(other);
  }
  return best;
}

double differing_share(const io::Image8& a, const io::Image8& b) {
  std::size_t differing = 0;
  const std::size_t pixels = a.pixels.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    int step = 0;
    for (std::size_t c = 0; c < 3; ++c)
      step = std::max(step, std::abs(int{a.pixels[3 * i + c]} - int{b.pixels[3 * i + c]}));
    differing += step > visible_step ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(pixels);
}

template <class Times>
double median_of(const std::vector<Times>& all, double Times::*stage) {
  std::vector<double> values;
  for (const Times& times : all) values.push_back(times.*stage);
  return median(values);
}
TenebraFrameTimes medians(const std::vector<TenebraFrameTimes>& all) {
  using T = TenebraFrameTimes;
  return {median_of(all, &T::evaluate), median_of(all, &T::raster), median_of(all, &T::points),
          median_of(all, &T::shadows),  median_of(all, &T::shade),  median_of(all, &T::total)};
}
EmbreeFrameTimes medians(const std::vector<EmbreeFrameTimes>& all) {
  using T = EmbreeFrameTimes;
  return {median_of(all, &T::evaluate), median_of(all, &T::tree),  median_of(all, &T::primary),
          median_of(all, &T::shadows),  median_of(all, &T::shade), median_of(all, &T::total)};
}

}  // namespace

Expected<FrameContestResult> run_frame_contest(const FrameTask& task, const FrameContest& contest) {
  auto ours = SceneRenderer::create({task.scene, task.width, task.height, task.threads});
  if (!ours) return tl::unexpected(ours.error());
  FrameContestResult result;
  std::vector<TenebraFrameTimes> our_times;
  std::vector<EmbreeFrameTimes> their_times, split_times;
  Expected<void> done;
  with_threads(task.threads, [&] {
    const std::unique_ptr<EmbreeRenderer> theirs = choose(task, contest.frames);
    result.embree_by = fmt::format("{}, {}", tree_name(theirs->kind()), packet_plan_name(theirs->plan()));
    for (int round = 0; round < contest.rounds && done; ++round) {
      for (const int frame : contest.frames) {
        const auto drawn = draw_ours(*ours, frame);
        if (!drawn) done = tl::unexpected(drawn.error());
        if (!done) return;
        const EmbreeFrameTimes times = theirs->draw(frame);
        if (round == 0)
          result.differing =
              std::max(result.differing, differing_share(ours->result().image, theirs->image()));
        if (frame == contest.frames.front()) continue;  // it comes after the last
        our_times.push_back(*drawn);
        their_times.push_back(times);
      }
    }
    for (const int frame : contest.frames) split_times.push_back(theirs->draw(frame, true));
  });
  if (!done) return tl::unexpected(done.error());
  if (result.differing > contest.most_differing) {
    return base::fail("{}, {}x{}: {:.2f} % of the pixels differ by more than {}/255, expected at most {} %",
                      contest.name, task.width, task.height, 100 * result.differing, visible_step,
                      100 * contest.most_differing);
  }
  result.ours = medians(our_times);
  result.theirs = medians(their_times);
  // Of frames that time both: their shares.
  const EmbreeFrameTimes split = medians(split_times);
  const double traced = result.theirs.primary + result.theirs.shadows;
  result.theirs.primary = traced * split.primary / (split.primary + split.shadows);
  result.theirs.shadows = traced - result.theirs.primary;
  result.lights = ours->result().masks.size();
  return result;
}

}  // namespace tenebra::bench
