// The BSP of line classes takes no more memory than its bound, within one point's query too.
#include <gtest/gtest.h>

#include <thread>

#include "soft/soft_frames.h"

namespace tenebra::testing {
namespace {

// Found on this scene: a tree was measured between points only, and one query took it to 227 MB.
TEST(TreeBound, HoldsWithinAQueryAndTheRestIsClipped) {
  const SoftCase c = frame_case({"court.glb", 60}, 48, 27, 10);
  SoftShadowConfig config;
  config.precision = SoftPrecision::reference;
  config.solver = SoftSolver::bsp;
  SoftStats stats;
  const SoftMask by_tree = traced(c, config, &stats);
  constexpr std::uint64_t bound = 4u << 20;  // a tree; each thread has one
  const std::uint64_t threads = std::max(1u, std::thread::hardware_concurrency());
  EXPECT_LE(stats.peak_tree_bytes, threads * bound);
  EXPECT_GT(stats.peak_tree_bytes, bound * 3 / 4) << "no tree came near its bound: nothing was tested";
  config.solver = SoftSolver::clip;
  const SoftMask clipped = traced(c, config);
  for (std::size_t i = 0; i < c.size(); ++i)
    ASSERT_NEAR(by_tree.visible_fraction[i], clipped.visible_fraction[i], 1e-6) << describe(c, i);
}

}  // namespace
}  // namespace tenebra::testing
