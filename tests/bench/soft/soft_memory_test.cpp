// SoftShadowConfig::memory_bytes against the heap itself, as the measuring program counts it.
#include <gtest/gtest.h>

#include <tenebra/threads.h>
#include <vector>
#include "bench/common/memory_meter.h"
#include "soft/soft_frames.h"

namespace tenebra::bench {
namespace {

using testing::SoftCase;

struct Held {
  double mb = 0;
  bool done = false;
};
Held measured(const SoftCase& c, const SoftShadowConfig& config) {
  Held run;
  SoftShadowTracer tracer;
  SoftMask mask;
  const MemoryMeter meter;
  with_threads(2,
               [&] { run.done = tracer.trace(c.points, c.normals, c.soup.view(), c.light, config, mask); });
  run.mb = meter.mb();
  return run;
}

TEST(SoftMemory, HoldsForTheHeap) {
  const SoftCase c = testing::frame_case({"court.glb", 60}, 48, 27, 2);
  for (const SoftSolver solver : {SoftSolver::bsp, SoftSolver::automatic}) {
    SoftShadowConfig config{.solver = solver, .tree_bytes = ~std::size_t{0}};
    config.memory_bytes = 1000;
    const Held refused = measured(c, config);  // what is held besides: masks, groups, blocks for the shafts
    EXPECT_FALSE(refused.done);
    const Held standard = measured(c, {.solver = solver});
    // Of auto, the least is just enough: groups wait for each other.
    for (const std::size_t mb : solver == SoftSolver::bsp ? std::vector<std::size_t>{40, 80, 160}
                                                          : std::vector<std::size_t>{30, 40}) {
      config.memory_bytes = mb * 1000000;
      const Held run = measured(c, config);
      EXPECT_TRUE(run.done) << mb;
      EXPECT_LE(run.mb, refused.mb + static_cast<double>(mb));
      if (solver == SoftSolver::bsp) {
        EXPECT_GE(run.mb, refused.mb + 0.2 * static_cast<double>(mb)) << "far less than allowed";
      }
      std::printf("%s, %zu MB: %.1f MB held, %.1f without candidates, %.1f by default\n",
                  std::string(soft_solver_name(solver)).c_str(), mb, run.mb, refused.mb, standard.mb);
    }
  }
}

}  // namespace
}  // namespace tenebra::bench
