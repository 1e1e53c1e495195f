// Both sides of a frame draw the same picture, and a contest says so where they do not.
#include "bench/frame/frame_contest.h"

#include <gtest/gtest.h>

#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"

namespace tenebra::bench {
namespace {

class FrameContestOfCity : public ::testing::Test {
protected:
  void SetUp() override {
    if (!has_ray_masks()) GTEST_SKIP() << "this Embree was built without ray masks";
    std::unique_ptr<testing::TemporaryFolder> made;
    auto loaded = load_scene(find_scene(bench_scene("city"), {}, made));
    ASSERT_TRUE(loaded) << loaded.error().message;
    scene_ = std::move(*loaded);
  }
  Expected<FrameContestResult> run(double most_differing) const {
    const shade::SurfaceTable surfaces(scene_);
    return run_frame_contest({scene_, surfaces, 101, 67, 2}, {"city 150", {149, 150}, 1, most_differing});
  }

  Scene scene_;
};

TEST_F(FrameContestOfCity, DrawsTheSamePicture) {
  const auto result = run(0.01);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->lights, 2u);
  EXPECT_GT(result->differing, 0)
      << "rays and raster agree in every edge: is one of them compared with itself?";
  const TenebraFrameTimes& ours = result->ours;
  EXPECT_GT(ours.evaluate, 0);
  EXPECT_GT(ours.shadows, 0);
  EXPECT_LE(ours.evaluate + ours.raster + ours.points + ours.shadows + ours.shade, ours.total);
  const EmbreeFrameTimes& theirs = result->theirs;
  EXPECT_GT(theirs.primary, 0);
  EXPECT_GT(theirs.shadows, 0);
  EXPECT_LE(theirs.evaluate + theirs.tree + theirs.primary + theirs.shadows + theirs.shade,
            1.001 * theirs.total);  // the sum is rounded
}

TEST_F(FrameContestOfCity, RefusesPicturesThatDiffer) {
  const auto result = run(0);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("city 150, 101x67: 0."), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("of the pixels differ by more than 16/255, expected at most 0 %"),
            std::string::npos)
      << result.error().message;
}

}  // namespace
}  // namespace tenebra::bench
