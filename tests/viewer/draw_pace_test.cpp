// When the window draws, and when it leaves the processors to a picture that is about to come.
#include "window/draw_pace.h"

#include <gtest/gtest.h>

namespace tenebra::viewer {
namespace {

DrawPace::Wall after(double seconds) {
  return DrawPace::Wall{} + std::chrono::hours(1) +
         std::chrono::duration_cast<DrawPace::Wall::duration>(std::chrono::duration<double>(seconds));
}

void draw(DrawPace& pace, double at_s) {
  pace.begin_draw(false, after(at_s));
  pace.end_draw();
}
/// As many times as it wants to.
int draw_all(DrawPace& pace, double at_s) {
  int drawn = 0;
  for (; pace.is_due() && drawn < 100; ++drawn) draw(pace, at_s);
  return drawn;
}
/// Nothing is due, and the screen shows what there is.
DrawPace at_rest() {
  DrawPace pace;
  draw_all(pace, 0);
  pace.presented();
  return pace;
}

TEST(DrawPace, DrawsAFewFramesAfterEachInput) {
  DrawPace pace;
  EXPECT_EQ(draw_all(pace, 0), 3) << "at the begin";
  pace.input_came();
  pace.input_came();
  EXPECT_EQ(draw_all(pace, 0), 3);
  pace.picture_came();
  EXPECT_EQ(draw_all(pace, 0), 1);
  pace.ask(1);
  pace.begin_draw(true, after(0));
  EXPECT_EQ(draw_all(pace, 0), 3) << "what the hand does was not all drawn";
}

TEST(DrawPace, WaitsForAPictureThatIsAboutToCome) {
  DrawPace pace = at_rest();
  EXPECT_FALSE(pace.wants_presenting(true, false, after(1))) << "nothing new is drawn";
  pace.input_came();
  draw(pace, 0.05);
  EXPECT_TRUE(pace.wants_presenting(false, false, after(0.05)));
  EXPECT_FALSE(pace.wants_presenting(false, true, after(0.05))) << "it brings the input's frame along";
  EXPECT_TRUE(pace.wants_presenting(true, true, after(0.05)));
  EXPECT_FALSE(pace.wants_presenting(false, true, after(0.29))) << "however long the screen was still before";
  EXPECT_TRUE(pace.wants_presenting(false, true, after(0.31))) << "but not for long";
  pace.picture_came();
  EXPECT_FALSE(pace.wants_presenting(false, true, after(0.06))) << "it is not drawn yet";
  draw(pace, 0.07);
  EXPECT_TRUE(pace.wants_presenting(false, true, after(0.07)));
}

TEST(DrawPace, TellsOnceWhatTheScreenShows) {
  DrawPace pace = at_rest();
  pace.picture_came();
  pace.input_came();
  draw(pace, 1);
  DrawPace::Presented done = pace.presented();
  EXPECT_TRUE(done.new_picture);
  EXPECT_EQ(done.picture, 1u);
  EXPECT_TRUE(done.newest);
  EXPECT_FALSE(done.inputs) << "two frames more settle it";
  pace.picture_came();
  draw_all(pace, 1);
  pace.picture_came();
  done = pace.presented();
  EXPECT_EQ(done.picture, 2u);
  EXPECT_FALSE(done.newest) << "one has come since the draw";
  EXPECT_FALSE(done.inputs) << "a frame is due";
  draw_all(pace, 1);
  done = pace.presented();
  EXPECT_TRUE(done.inputs);
  EXPECT_TRUE(done.newest);
  done = pace.presented();
  EXPECT_FALSE(done.new_picture);
  EXPECT_FALSE(done.inputs);
}

TEST(DrawPace, SleepsAsLongAsNothingMoves) {
  DrawPace pace = at_rest();
  EXPECT_DOUBLE_EQ(pace.sleep_s({}, after(1)), 0.5);
  EXPECT_DOUBLE_EQ(pace.sleep_s({.moves = true, .look_again_s = 9}, after(1)), 0.1);
  EXPECT_DOUBLE_EQ(pace.sleep_s({.moves = true, .look_again_s = 0.02}, after(1)), 0.02);
  pace.input_came();
  EXPECT_EQ(pace.sleep_s({.hurries = true}, after(1)), 0) << "the input's frame";
  draw(pace, 1);
  EXPECT_NEAR(pace.sleep_s({.hurries = true}, after(1.004)), 0.006, 1e-6)
      << "the screen does not show it yet";
  draw_all(pace, 1);
  EXPECT_NEAR(pace.sleep_s({.hurries = true}, after(1.05)), 0.2, 1e-6) << "until it is shown in any case";
  EXPECT_NEAR(pace.sleep_s({.hurries = true}, after(2)), 1e-3, 1e-6);
}

}  // namespace
}  // namespace tenebra::viewer
