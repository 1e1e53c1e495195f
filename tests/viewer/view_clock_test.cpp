// The animation clock: time by the wall clock, or by fixed steps.
#include <gtest/gtest.h>

#include "window/motion/animation_clock.h"

namespace tenebra::viewer {
namespace {

using Wall = AnimationClock::Wall;

Wall at(double seconds) {
  return Wall{} + std::chrono::duration_cast<Wall::duration>(std::chrono::duration<double>(seconds));
}

/// Two seconds from 1 to 3: frames 0..60 at 30 a second.
Clip two_seconds() {
  Clip clip;
  clip.start_s = 1;
  clip.end_s = 3;
  return clip;
}

TEST(AnimationClock, RunsByTheWallClockNotByCalls) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  EXPECT_EQ(clock.frames(), 61);
  EXPECT_DOUBLE_EQ(clock.time_at(at(100)), 1);
  clock.play(at(100));
  EXPECT_NEAR(clock.time_at(at(100.5)), 1.5, 1e-8);
  EXPECT_NEAR(clock.time_at(at(100.5)), 1.5, 1e-8) << "asking does not move it";
  clock.set_speed(at(100.5), 4);
  EXPECT_NEAR(clock.time_at(at(100.75)), 2.5, 1e-8) << "a new speed acts from now on";
  clock.pause(at(100.75));
  EXPECT_NEAR(clock.time_at(at(500)), 2.5, 1e-8);
}

TEST(AnimationClock, WrapsBothWaysAndStopsWithoutLoop) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  clock.play(at(0));
  EXPECT_NEAR(clock.time_at(at(5)), 2.0, 1e-8) << "two rounds and a half";
  clock.set_speed(at(5), -1);
  EXPECT_NEAR(clock.time_at(at(6.5)), 2.5, 1e-8) << "backwards through the begin";
  EXPECT_FALSE(clock.is_over(at(1000)));
  clock.set_loop(at(6.5), false);
  EXPECT_DOUBLE_EQ(clock.time_at(at(100)), 1.0);
  EXPECT_TRUE(clock.is_over(at(100)));
  clock.pause(at(100));
  clock.play(at(101));
  EXPECT_NEAR(clock.time_at(at(101)), 3.0, 1e-8) << "playing again begins at the other end";
}

TEST(AnimationClock, StandsUnderTheHandAndPlaysOnWhenItLetsGo) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  clock.set_loop(at(0), false);
  clock.play(at(0));
  clock.set_held(at(0.5), true);
  EXPECT_NEAR(clock.time_at(at(50)), 1.5, 1e-8);
  EXPECT_TRUE(clock.playing());
  EXPECT_FALSE(clock.runs());
  clock.seek(at(50), 3);
  EXPECT_FALSE(clock.is_over(at(51))) << "held at the end it is not over: the hand may come back";
  clock.seek(at(52), 2);
  clock.set_held(at(60), true);
  EXPECT_EQ(clock.time_at(at(60)), 2);
  clock.set_held(at(60), false);
  EXPECT_NEAR(clock.time_at(at(60.25)), 2.25, 1e-8);
  EXPECT_TRUE(clock.is_over(at(62)));
}

TEST(AnimationClock, LimitsSpeedAndTime) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  clock.set_speed(at(0), 100);
  EXPECT_EQ(clock.speed(), 4);
  clock.set_speed(at(0), -100);
  EXPECT_EQ(clock.speed(), -4);
  clock.seek(at(0), 99);
  EXPECT_EQ(clock.time_at(at(0)), 3);
  clock.seek(at(0), -99);
  EXPECT_EQ(clock.time_at(at(0)), 1);
}

TEST(AnimationClock, StepsToWholeFramesWithTheBitsOfRender) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  for (int frame = 0; frame < clock.frames(); ++frame) {
    EXPECT_EQ(clock.time_at(at(0)), frame_time_s(clip, frame, 30.0)) << frame;
    EXPECT_EQ(clock.frame_of(clock.time_at(at(0))), frame);
    clock.step(at(0), 1);
  }
  EXPECT_EQ(clock.time_at(at(0)), 1) << "around the end";
  clock.step(at(0), -1);
  EXPECT_EQ(clock.frame_of(clock.time_at(at(0))), 60);
  clock.seek(at(0), frame_time_s(clip, 10, 30.0) + 0.01);
  clock.step(at(0), -1);
  EXPECT_EQ(clock.frame_of(clock.time_at(at(0))), 10) << "from between frames back to the last one";
}

TEST(AnimationClock, FixedStepsMoveByPicturesOnly) {
  const Clip clip = two_seconds();
  AnimationClock clock(&clip);
  clock.set_fixed_step(at(0), true);
  clock.set_loop(at(0), false);
  clock.play(at(0));
  EXPECT_EQ(clock.time_at(at(50)), 1) << "the wall clock moves nothing";
  int pictures = 1;
  while (!clock.is_over(at(0)) && pictures < 1000) {
    clock.advance_frame();
    ++pictures;
  }
  EXPECT_EQ(pictures, 61);
  EXPECT_EQ(clock.time_at(at(0)), 3);
}

TEST(AnimationClock, KnowsScenesWithoutAnimationAndClipsWithoutLength) {
  AnimationClock still;
  still.play(at(0));
  EXPECT_EQ(still.time_at(at(9)), 0);
  EXPECT_EQ(still.frames(), 1);
  still.step(at(9), 1);
  EXPECT_EQ(still.time_at(at(9)), 0);

  Clip moment;
  moment.start_s = moment.end_s = 2;
  AnimationClock clock(&moment);
  clock.play(at(0));
  EXPECT_EQ(clock.time_at(at(9)), 2);
  clock.advance_frame();
  EXPECT_EQ(clock.time_at(at(9)), 2);
}

}  // namespace
}  // namespace tenebra::viewer
