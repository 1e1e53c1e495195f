// The BSP of line classes takes no more memory than its bound, within one point's query too.
#include <gtest/gtest.h>

#include <tenebra/threads.h>
#include "soft/soft_frames.h"

namespace tenebra::testing {
namespace {

constexpr std::size_t kib = 1024;

// Its trees come to 227 MB without a bound. Found on it: a tree was measured between points only.
SoftCase court() {
  return frame_case({"court.glb", 60}, 48, 27, 10);
}
SoftShadowConfig bounded(std::size_t bytes, bool keep_trees) {
  SoftShadowConfig config;
  config.precision = SoftPrecision::reference;
  config.solver = SoftSolver::bsp;
  config.keep_trees = keep_trees;
  config.tree_bytes = bytes;
  return config;
}
/// One thread: the peak is that of one tree.
SoftMask on_one_thread(const SoftCase& c, const SoftShadowConfig& config, SoftStats& stats) {
  SoftMask mask;
  with_threads(1, [&] { mask = traced(c, config, &stats); });
  return mask;
}

TEST(TreeBound, HoldsWithinAQueryAndTheRestIsClipped) {
  const SoftCase c = court();
  SoftShadowConfig clip = bounded(0, true);
  clip.solver = SoftSolver::clip;
  const SoftMask clipped = traced(c, clip);
  for (const std::size_t bound : {4096 * kib, 64 * kib, 0 * kib}) {
    for (const bool keep : {true, false}) {
      SCOPED_TRACE(::testing::Message() << bound << " bytes, trees " << (keep ? "kept" : "anew"));
      SoftStats stats;
      const SoftMask by_tree = on_one_thread(c, bounded(bound, keep), stats);
      EXPECT_LE(stats.peak_tree_bytes, bound);
      EXPECT_GE(stats.peak_tree_bytes, bound / 2) << "no tree came near its bound: nothing was tested";
      EXPECT_GT(stats.points_clip, 0u) << "no tree came to its bound: nothing was tested";
      EXPECT_EQ(stats.points_bsp > 0, bound > 0);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_NEAR(by_tree.visible_fraction[i], clipped.visible_fraction[i], 1e-6) << describe(c, i);
    }
  }
}

// Found on BART's kitchen: after one tree came to its bound, no point of the group got a tree any more, and
// "each query starting anew" was mostly clipping.
TEST(TreeBound, ATreeThatStartsAnewForgetsTheDroppedOne) {
  const SoftCase c = court();
  SoftStats kept, anew;
  on_one_thread(c, bounded(64 * kib, true), kept);
  on_one_thread(c, bounded(64 * kib, false), anew);
  EXPECT_GT(anew.points_bsp, kept.points_bsp) << "a tree asked once stays smaller than one asked often";
}

}  // namespace
}  // namespace tenebra::testing
