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
    // Ray masks, by which the opponent leaves out what casts no shadow, are an option of Embree's build.
    if (!has_ray_masks()) GTEST_SKIP() << "this Embree was built without ray masks";
    std::unique_ptr<testing::TemporaryFolder> made;
    auto loaded = load_scene(find_scene(bench_scene("city"), {}, made));
    ASSERT_TRUE(loaded) << loaded.error().message;
    scene_ = std::move(*loaded);
  }
  /// `theirs`: the scene whose surfaces the opponent shades.
  Expected<FrameContestResult> run(const Scene& theirs) const {
    const shade::SurfaceTable surfaces(theirs);
    return run_frame_contest({scene_, surfaces, 101, 67, 2}, {"city 150", {149, 150}, 1, 0.01});
  }

  Scene scene_;
};

TEST_F(FrameContestOfCity, DrawsTheSamePicture) {
  const auto result = run(scene_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->lights, 2u);
  EXPECT_LE(result->differing, 0.01);
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
  Scene red = scene_;
  for (Material& material : red.materials) material.base_color = {1, 0, 0};
  const auto result = run(red);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("city 150, 101x67: "), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("of the pixels differ by more than 16/255, expected at most 1 %"),
            std::string::npos)
      << result.error().message;
}

}  // namespace
}  // namespace tenebra::bench
