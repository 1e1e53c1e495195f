// Tracks by hand: glTF's three interpolations and the corners of BART's splines.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <tenebra/animation.h>

namespace tenebra {
namespace {

double value(const Track& track, double time_s) {
  double out = 0;
  evaluate_track(track, time_s, false, {&out, 1});
  return out;
}

glm::dvec4 rotation(const Track& track, double time_s) {
  glm::dvec4 out;
  evaluate_track(track, time_s, true, {&out.x, 4});
  return out;
}

Track scalar(Interpolation interpolation, std::vector<double> times_s, std::vector<double> values) {
  Track track;
  track.interpolation = interpolation;
  track.components = 1;
  track.times_s = std::move(times_s);
  track.values = std::move(values);
  if (interpolation == Interpolation::kochanek_bartels) track.tcb.resize(track.times_s.size());
  return track;
}

TEST(Track, StepHoldsUntilTheNextKey) {
  const Track track = scalar(Interpolation::step, {1, 2, 4}, {10, 20, 40});
  EXPECT_EQ(value(track, 0), 10);
  EXPECT_EQ(value(track, std::nextafter(2.0, 0.0)), 10);
  EXPECT_EQ(value(track, 2), 20);
  EXPECT_EQ(value(track, 9), 40);
}

TEST(Track, LinearBlendsAndClamps) {
  const Track track = scalar(Interpolation::linear, {1, 2, 2, 4}, {10, 20, 30, 50});
  EXPECT_EQ(value(track, -1e300), 10);
  EXPECT_EQ(value(track, 1.25), 12.5);
  EXPECT_EQ(value(track, 2), 30);
  EXPECT_EQ(value(track, 3), 40);
  EXPECT_EQ(value(track, 1e300), 50);
}

TEST(Track, OneKeyAndNoKeyHold) {
  for (const auto kind : {Interpolation::step, Interpolation::linear, Interpolation::kochanek_bartels}) {
    EXPECT_EQ(value(scalar(kind, {1}, {7}), 0), 7);
    EXPECT_EQ(value(scalar(kind, {}, {}), 0), 0);
  }
  EXPECT_EQ(rotation(Track{.components = 4, .times_s = {}, .values = {}, .tcb = {}}, 0),
            glm::dvec4(0, 0, 0, 1));
}

TEST(Track, LinearRotationTakesTheShortWay) {
  const double s = std::sqrt(0.5);
  Track track{.components = 4, .times_s = {0, 1}, .values = {0, 0, 0, 1, 0, -s, 0, -s}, .tcb = {}};
  const glm::dvec4 half = rotation(track, 0.5);  // 45 degrees about Y
  EXPECT_NEAR(std::abs(half.y), std::sin(M_PI / 8), 1e-12);
  EXPECT_NEAR(std::abs(half.w), std::cos(M_PI / 8), 1e-12);
  track.interpolation = Interpolation::step;
  EXPECT_NEAR(rotation(track, 0.5).w, 1.0, 1e-12);
}

TEST(Track, CubicSplineUsesTangentsASecond) {
  // keys (in, value, out): at 0 s value 1, out 2; at 2 s value 3, in -1. u = 1/2: (1 + 3) / 2 + 2 (2 - -1)
  // / 8.
  const Track track = scalar(Interpolation::cubic_spline, {0, 2}, {9, 1, 2, -1, 3, 9});
  EXPECT_NEAR(value(track, 1), 2.75, 1e-12);
  EXPECT_EQ(value(track, -1), 1);
  EXPECT_EQ(value(track, 2), 3);
}

TEST(KochanekBartels, FirstAndLastKeyOnlyShapeTangents) {
  const Track track = scalar(Interpolation::kochanek_bartels, {0, 1, 2, 3}, {100, 0, 1, 100});
  EXPECT_EQ(value(track, 0.5), 0);
  EXPECT_EQ(value(track, 2.5), 1);
  // tangents -49.5 and 50 at even spacing: P(1/2) = 1/2 + (-49.5 - 50) / 8
  EXPECT_NEAR(value(track, 1.5), 0.5 - 99.5 / 8, 1e-12);
}

TEST(KochanekBartels, FullTensionStopsAtTheKeys) {
  Track track = scalar(Interpolation::kochanek_bartels, {0, 1, 2, 3}, {100, 0, 1, 100});
  for (glm::dvec3& tcb : track.tcb) tcb.x = 1;
  EXPECT_NEAR(value(track, 1.5), 0.5, 1e-12);
  EXPECT_NEAR(value(track, 1.25), 3 * 0.0625 - 2 * 0.015625, 1e-12);
}

TEST(KochanekBartels, StraightLinesStayStraightAtUnevenTimes) {
  const Track track = scalar(Interpolation::kochanek_bartels, {0, 1, 4, 5, 9}, {0, 1, 4, 5, 9});
  for (double t = 1; t <= 5; t += 0.125) EXPECT_NEAR(value(track, t), t, 1e-12);
}

TEST(KochanekBartels, ZeroSegmentsJumpAndDoubledEndsHold) {
  const Track track = scalar(Interpolation::kochanek_bartels, {0, 0, 1, 1, 2, 2}, {0, 0, 1, 5, 6, 6});
  EXPECT_NEAR(value(track, std::nextafter(1.0, 0.0)), 1, 1e-9);
  EXPECT_EQ(value(track, 1), 5);
  EXPECT_EQ(value(track, 2), 6);
  for (double t = -1; t < 3; t += 0.01) EXPECT_TRUE(std::isfinite(value(track, t)));
}

TEST(KochanekBartels, TimeThatRunsBackwardsTakesTheFirstSegmentThatEndsLater) {
  const Track track =
      scalar(Interpolation::kochanek_bartels, {0, 1, 8, 4, 6, 9, 10, 11}, {0, 1, 8, 100, 100, 100, 100, 100});
  EXPECT_NEAR(value(track, 7.999999), 8, 1e-3);  // still on the first run
  EXPECT_GT(value(track, 8.5), 50);              // the second run, past its 6
  EXPECT_EQ(value(track, 10), 100);
}

Track turns(std::vector<double> angles) {
  Track track;
  track.interpolation = Interpolation::kochanek_bartels;
  track.components = 4;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    track.times_s.push_back(static_cast<double>(i));
    track.values.insert(track.values.end(), {0, 0, std::sin(angles[i] / 2), std::cos(angles[i] / 2)});
  }
  track.tcb.resize(angles.size());
  return track;
}

TEST(KochanekBartels, EvenTurnsStayEven) {
  const Track track = turns({0, 0.5, 1.0, 1.5, 2.0});
  for (double t = 1; t <= 3; t += 0.0625) {
    const glm::dvec4 q = rotation(track, t);
    EXPECT_NEAR(2 * std::atan2(q.z, q.w), 0.5 * t, 1e-9) << t;
  }
}

TEST(KochanekBartels, LongAxesAreClampedNotNaN) {
  Track track = turns({0, 0.5, 0.1, 1.5, 2.0});
  for (double& v : track.values) v *= 1.5;
  for (double t = 0; t < 5; t += 0.01) {
    const glm::dvec4 q = rotation(track, t);
    EXPECT_NEAR(glm::length(q), 1.0, 1e-9) << t;
  }
}

TEST(Frames, LastFrameIsExactlyTheEnd) {
  Clip clip;
  clip.start_s = -1;
  clip.end_s = 5;
  clip.frame_count = 300;
  EXPECT_EQ(frame_time_s(clip, 0, 30), -1);
  EXPECT_EQ(frame_time_s(clip, 299, 30), 5);
  EXPECT_NEAR(frame_time_s(clip, 60, 30), 0.204013, 1e-6);
  EXPECT_EQ(frame_count(clip, 30), 300);
}

TEST(Frames, AreCutWhereTheFileStatesNone) {
  Clip clip;
  clip.end_s = 0.7;
  EXPECT_EQ(frame_count(clip, 30), 22);
  EXPECT_EQ(frame_time_s(clip, 15, 30), 0.5);
  clip.end_s = 0;
  EXPECT_EQ(frame_count(clip, 30), 1);
  clip.end_s = 1e300;
  EXPECT_EQ(frame_count(clip, 30), 1'000'000'001);
}

}  // namespace
}  // namespace tenebra
