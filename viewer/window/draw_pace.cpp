#include "window/draw_pace.h"

#include <utility>

namespace tenebra::viewer {
namespace {

constexpr double look_again_s = 0.1;            // while the worker is busy: progress
constexpr double longest_unpresented_s = 0.25;  // while a picture is about to come
constexpr double turn_s = 0.01;
constexpr double resting_sleep_s = 0.5;  // signals are looked at this often

double seconds(AnimationClock::Wall from, AnimationClock::Wall to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

double DrawPace::since_drawn_s(Wall now) const {
  return seconds(last_draw_, now);
}

void DrawPace::begin_draw(bool settles, Wall now) {
  last_draw_ = now;
  due_ = std::max(settles ? 3 : 0, due_ - 1);
}

void DrawPace::end_draw() {
  drawn_ = pictures_;
  if (!unpresented_) unpresented_since_ = last_draw_;
  unpresented_ = true;
}

bool DrawPace::wants_presenting(bool wanted, bool hurries, Wall now) const {
  if (!unpresented_) return false;
  return shown_ != drawn_ || wanted || seconds(unpresented_since_, now) >= longest_unpresented_s || !hurries;
}

DrawPace::Presented DrawPace::presented() {
  unpresented_ = false;
  Presented done;
  done.picture = drawn_;
  done.new_picture = std::exchange(shown_, drawn_) != drawn_;
  done.newest = shown_ == pictures_;
  if (due_ == 0) done.inputs = std::exchange(input_undrawn_, false);
  return done;
}

double DrawPace::sleep_s(const Stir& stir, Wall now) const {
  // Frames that the screen does not show yet are drawn no more often than a user could notice.
  if (is_due()) return unpresented_ && stir.hurries ? std::max(0.0, turn_s - since_drawn_s(now)) : 0;
  double sleep_s = stir.moves ? std::min(look_again_s, stir.look_again_s) : resting_sleep_s;
  if (unpresented_)
    sleep_s = std::min(sleep_s, std::max(1e-3, longest_unpresented_s - seconds(unpresented_since_, now)));
  return sleep_s;
}

}  // namespace tenebra::viewer
