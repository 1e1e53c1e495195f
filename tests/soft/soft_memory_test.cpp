// SoftShadowConfig::memory_bytes: one bound for what all threads hold. What is found within it follows from
// the bound alone, never from the number of threads or from frames before.
#include <gtest/gtest.h>

#include <tenebra/threads.h>
#include "soft/soft_frames.h"

namespace tenebra::testing {
namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

SoftCase court(double percent) {
  return frame_case({"court.glb", 60}, 48, 27, percent);
}
SoftShadowConfig bounded(SoftSolver solver, std::size_t bytes) {
  SoftShadowConfig config;
  config.solver = solver;
  config.tree_bytes = ~std::size_t{0};
  config.memory_bytes = bytes;
  return config;
}
struct Traced {
  SoftMask mask;
  SoftStats stats;
  std::string refusal;
  bool done = false;
};
Traced trace_with(SoftShadowTracer& tracer, const SoftCase& c, const SoftShadowConfig& config, int threads) {
  Traced out;
  with_threads(threads, [&] {
    out.done = tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, config, out.mask);
  });
  out.stats = tracer.stats();
  out.refusal = tracer.refusal();
  return out;
}
Traced on_threads(const SoftCase& c, const SoftShadowConfig& config, int threads) {
  SoftShadowTracer tracer;
  return trace_with(tracer, c, config, threads);
}
void expect_same(const Traced& a, const Traced& b) {
  EXPECT_TRUE(a.done && b.done);
  EXPECT_EQ(a.mask.visible_fraction, b.mask.visible_fraction);
  EXPECT_EQ(a.mask.irradiance, b.mask.irradiance);
  EXPECT_EQ(a.stats.groups_changed, b.stats.groups_changed);
  EXPECT_EQ(a.stats.points_bsp, b.stats.points_bsp);
  EXPECT_EQ(a.stats.points_clip, b.stats.points_clip);
  EXPECT_EQ(a.stats.tree_nodes, b.stats.tree_nodes);
  EXPECT_EQ(a.stats.candidates, b.stats.candidates);
  EXPECT_EQ(a.stats.points_penumbra, b.stats.points_penumbra);
}

TEST(SoftMemory, GivesTreesAnySize) {
  const SoftCase c = court(0.5);
  const Traced all = on_threads(c, bounded(SoftSolver::bsp, 512 * mib), 1);
  ASSERT_TRUE(all.done);
  EXPECT_EQ(all.stats.groups_changed, 0u);
  EXPECT_GT(all.stats.peak_tree_bytes, 4 * mib) << "no tree was large: nothing was tested";
  const Traced standard = on_threads(c, {.solver = SoftSolver::bsp}, 1);
  EXPECT_GT(standard.stats.groups_changed, 0u);
  EXPECT_GT(all.stats.points_bsp, standard.stats.points_bsp);
}

TEST(SoftMemory, WhatIsFoundFollowsFromTheBoundAlone) {
  const SoftCase c = court(2);
  for (const std::size_t bytes : {40 * mib, 60 * mib}) {
    SCOPED_TRACE(::testing::Message() << bytes / mib << " MiB");
    const SoftShadowConfig config = bounded(SoftSolver::bsp, bytes);
    const Traced one = on_threads(c, config, 1);
    EXPECT_GT(one.stats.groups_changed, 0u) << "the bound is too large to test anything";
    EXPECT_GT(one.stats.points_bsp, 0u) << "the bound is too small to test anything";
    SoftShadowTracer tracer;
    static_cast<void>(trace_with(tracer, c, {.solver = SoftSolver::bsp}, 4));  // its history
    for (const int threads : {2, 7}) {
      const Traced many = trace_with(tracer, c, config, threads);
      expect_same(one, many);
      EXPECT_LE(many.stats.peak_tree_bytes, bytes);
    }
  }
}

// At the smaller bounds groups, and families of them, wait for each other, and what is solved with what must
// not change for that: the bits are those without a bound, or the frame is refused.
TEST(SoftMemory, DoesNotChangeWhatTheOtherSolversFind) {
  const SoftCase c = court(2);
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::clip}) {
    SoftShadowConfig free = bounded(solver, 0);
    free.memory_bytes.reset();
    const Traced unbounded = on_threads(c, free, 1);
    for (const std::size_t mb : {12, 16, 20, 24, 28, 40}) {
      SCOPED_TRACE(::testing::Message() << soft_solver_name(solver) << ", " << mb << " MiB");
      for (const int threads : {1, 2, 7}) {
        const Traced run = on_threads(c, bounded(solver, mb * mib), threads);
        EXPECT_TRUE(run.done || (mb < 28 && !run.refusal.empty()));
        if (run.done) expect_same(unbounded, run);
      }
    }
  }
}

TEST(SoftMemory, RefusesAFrameWhoseGroupsDoNotFitAlone) {
  const SoftCase c = court(2);
  SoftShadowTracer tracer;
  std::string sentence;
  for (const SoftSolver solver : {SoftSolver::bsp, SoftSolver::automatic}) {
    for (const int threads : {1, 2, 7}) {
      const Traced refused = trace_with(tracer, c, bounded(solver, 2 * mib), threads);
      EXPECT_FALSE(refused.done);
      EXPECT_NE(refused.refusal.find("--memory soft:MB"), std::string::npos) << refused.refusal;
      if (threads == 1) sentence = refused.refusal;
      EXPECT_EQ(refused.refusal, sentence);
    }
  }
  SoftShadowConfig free;
  const Traced after = trace_with(tracer, c, free, 2);
  EXPECT_EQ(after.refusal, "");
  expect_same(after, on_threads(c, free, 2));
}

}  // namespace
}  // namespace tenebra::testing
