// The measurement of promises, on one small view.
#include <gtest/gtest.h>

#include "bench/promise/promise_runs.h"

namespace tenebra {
namespace {

TEST(PromiseBench, ComparesEachErrorWithTheExactPicture) {
  settings::SceneSettings scene;
  scene.file = TENEBRA_SCENES_DIR "/court.glb";
  scene.exposure_given = true;
  scene.size = settings::Size{128, 72};
  render::RasterChoice raster;
  raster.kind = render::RasterKind::cpu;
  auto session = session::Session::open(scene, raster);
  ASSERT_TRUE(session) << session.error().message;
  session->place(0, session::rays_of(session->staged(), session::viewpoint_of(session->staged(), scene), 0,
                                     *scene.size));
  bench::PromiseTable table;
  ASSERT_TRUE(bench::measure_view(*session, {"court 0", 0, false, 4, 1}, table));
  ASSERT_EQ(table.runs.size(), 5u);
  for (const bench::PromiseRun& run : table.runs) {
    EXPECT_GE(run.penumbra, 100u);
    EXPECT_LE(run.rms, 1.25 * run.asked) << run.asked;
    EXPECT_GT(run.over_exact, 0);
  }
}

}  // namespace
}  // namespace tenebra
