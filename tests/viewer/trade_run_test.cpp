// What `tenebra trade` draws to try settings and to time them: counted, as times themselves can't be tested.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <tenebra/stop_flag.h>

#include "session/viewpoint.h"
#include "trade/trade_run.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using viewer::PlannedFrame;
using viewer::TradePoint;
using viewer::TradeRequest;
using viewer::TradeSetting;

/// A request to draw the moving scene, each frame once, with the times of all that were drawn.
class TradeRun : public ::testing::Test {
protected:
  void SetUp() override {
    options_.file = write_moving_scene(folder_).string();
    options_.size = viewer::Size{32, 24};
    auto plan = session::stage_scene(options_);
    ASSERT_TRUE(plan) << plan.error().message;
    plan_ = std::move(*plan);
    request_.scene = std::make_shared<const session::StagedScene>(plan_);
    request_.clip = plan_.clip;
    request_.frames = {{30, 1}};
    request_.settings.width = plan_.size.width, request_.settings.height = plan_.size.height;
    request_.raster.kind = render::RasterKind::cpu;
    request_.view = [this](double time_s) {
      drawn_.push_back(time_s);
      return session::rays_of(plan_, session::viewpoint_of(plan_, options_), time_s, plan_.size);
    };
    request_.axes.antialias = {1, 4};
    request_.repeats = 1;
  }
  /// The times of the frames that are drawn to time a setting whose frame takes about `ms`: after the first,
  /// which only warms up.
  std::vector<double> timed(double ms) {
    drawn_.clear();
    double progress = 0;
    const auto found = time_setting(
        request_, TradePoint{{}, ms, 0}, [&](double p) { progress = p; }, stop_);
    EXPECT_TRUE(found) << found.error().message;
    EXPECT_GT(found.value_or(0), 0);
    EXPECT_NEAR(progress, 1, 1e-12);
    if (drawn_.empty()) return {};
    return {drawn_.begin() + 1, drawn_.end()};
  }

  TemporaryFolder folder_;
  viewer::SceneOptions options_;
  session::StagedScene plan_;
  TradeRequest request_;
  StopFlag stop_;
  std::vector<double> drawn_;
};

TEST_F(TradeRun, TimesTheFrameOfAStillSceneAgainAndAgain) {
  EXPECT_EQ(timed(0.1), std::vector<double>(16, 1.0));
  EXPECT_EQ(timed(800), std::vector<double>(10, 1.0)) << "as many as fit into eight seconds";
  EXPECT_EQ(timed(1e4), std::vector<double>(5, 1.0)) << "but not fewer";
}

TEST_F(TradeRun, TimesFramesThatWereNotTried) {
  for (int i = 0; i < 9; ++i) request_.more_frames.push_back({60 + 6 * i, 2 + 0.2 * i});
  std::vector<double> all;
  for (const PlannedFrame& frame : request_.more_frames) all.push_back(frame.time_s);
  EXPECT_EQ(timed(0.1), all) << "each of them once";
  EXPECT_EQ(timed(1e4), (std::vector<double>{all[0], all[2], all[4], all[6], all[8]})) << "spread evenly";
  request_.more_frames.resize(2);
  EXPECT_EQ(timed(0.1), (std::vector<double>{all[0], all[0], all[1], all[1], all[1]}))
      << "never fewer than five times";
}

TEST_F(TradeRun, TimesMoreFramesBeforeItTimesOneAgain) {
  for (int i = 0; i < 16; ++i) request_.more_frames.push_back({60 + 6 * i, 2 + 0.2 * i});
  request_.repeats = 15;
  const auto frames = [&](double ms) {
    const std::vector<double> drawn = timed(ms);
    return std::pair(drawn.size(), std::set(drawn.begin(), drawn.end()).size());
  };
  using Counts = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(frames(0.1), Counts(240, 16)) << "each of them fifteen times";
  EXPECT_EQ(frames(100), Counts(80, 16)) << "each five times, in eight seconds";
  EXPECT_EQ(frames(450), Counts(16, 16));
  EXPECT_EQ(frames(1000), Counts(8, 8));
}

TEST_F(TradeRun, DrawsAllFramesWithTheFinestAndTheStandardSetting) {
  request_.axes.antialias = {1, 4, 16};
  request_.frames = {{0, 0}, {150, 5}, {300, 10}};
  double progress = 0;
  const auto result = run_trade(
      request_,
      [&](double p) {
        EXPECT_GE(p, progress);
        progress = p;
      },
      stop_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LE(progress, 1);
  for (const PlannedFrame& frame : request_.frames)
    EXPECT_GE(std::count(drawn_.begin(), drawn_.end(), frame.time_s), 2) << "with each of the two settings";
  EXPECT_EQ(result->frames, (std::vector<int>{0, 150, 300}));
  const auto measured = [&](const TradeSetting& setting) {
    return std::find_if(result->measured.begin(), result->measured.end(),
                        [&](const auto& m) { return m.point.setting == setting; });
  };
  const auto finest = measured(viewer::finest(request_.axes)), standard = measured({4, 0, 0});
  ASSERT_NE(finest, result->measured.end());
  ASSERT_NE(standard, result->measured.end());
  EXPECT_EQ(finest->point.error, 0) << "errors are against it";
  EXPECT_GT(standard->point.error, 0);
  ASSERT_EQ(standard->frame_errors.size(), 3u);
  double squares = 0;
  for (const double error : standard->frame_errors) squares += error * error;
  EXPECT_NEAR(standard->point.error, std::sqrt(squares / 3), 1e-12);
  EXPECT_EQ(standard->worst_error, std::ranges::max(standard->frame_errors));
}

TEST_F(TradeRun, ErrorsOfFramesThatWereNotTriedWidenTheSpread) {
  const std::vector<PlannedFrame> from_afar{{0, 0}, {3, 0.1}}, near{{150, 5}, {153, 5.1}};
  viewer::SceneOptions afar = options_;
  afar.eye = glm::vec3(0, 10, 40);
  request_.view = [&](double time_s) {
    return session::rays_of(plan_, session::viewpoint_of(plan_, time_s < 1 ? afar : options_), time_s,
                            plan_.size);
  };
  request_.frames = from_afar, request_.more_frames = near;
  const auto wider = run_trade(request_, {}, stop_);
  ASSERT_TRUE(wider) << wider.error().message;
  EXPECT_GT(wider->spread, 1.2);
  request_.frames = near, request_.more_frames = from_afar;
  const auto narrower = run_trade(request_, {}, stop_);
  ASSERT_TRUE(narrower) << narrower.error().message;
  EXPECT_EQ(narrower->spread, 1);
}

TEST_F(TradeRun, AStopEndsIt) {
  stop_.request();
  const auto result = run_trade(request_, {}, stop_);
  ASSERT_FALSE(result);
  EXPECT_TRUE(is_stop(result));
  const auto time = time_setting(request_, TradePoint{{}, 1, 0}, {}, stop_);
  ASSERT_FALSE(time);
  EXPECT_TRUE(is_stop(time));
}

}  // namespace
}  // namespace tenebra::testing
