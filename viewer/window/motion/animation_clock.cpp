#include "window/motion/animation_clock.h"

#include <algorithm>
#include <cmath>

namespace tenebra::viewer {

AnimationClock::AnimationClock(const Clip* clip, double fps) : fps_(fps) {
  if (clip) {
    timing_.start_s = clip->start_s;
    timing_.end_s = clip->end_s;
    timing_.frame_count = clip->frame_count;
  } else {
    timing_.frame_count = 1;
  }
  anchor_s_ = timing_.start_s;
}

int AnimationClock::frames() const {
  return frame_count(timing_, fps_);
}

double AnimationClock::frame_time_s(int frame) const {
  return tenebra::frame_time_s(timing_, frame, fps_);
}

int AnimationClock::frame_of(double time_s) const {
  const int last = frames() - 1;
  if (last < 1) return 0;
  const double step_s = frame_time_s(1) - frame_time_s(0);
  int frame = step_s > 0 ? static_cast<int>(std::clamp((time_s - start_s()) / step_s, 0.0, 1.0 * last)) : 0;
  while (frame < last && frame_time_s(frame + 1) <= time_s) ++frame;
  while (frame > 0 && frame_time_s(frame) > time_s) --frame;
  return frame;
}

double AnimationClock::time_at(Wall now) const {
  if (!runs() || fixed_step_) return anchor_s_;
  const double length_s = end_s() - start_s();
  if (!(length_s > 0)) return start_s();
  const double moved_s =
      anchor_s_ - start_s() + speed_ * std::chrono::duration<double>(now - anchor_).count();
  if (!loop_) return start_s() + std::clamp(moved_s, 0.0, length_s);
  const double rest_s = std::fmod(moved_s, length_s);
  return start_s() + (rest_s < 0 ? rest_s + length_s : rest_s);
}

bool AnimationClock::is_over(Wall now) const {
  if (!runs() || loop_ || speed_ == 0) return false;
  const double time_s = time_at(now);
  if (fixed_step_) return frame_of(time_s) == (speed_ < 0 ? 0 : frames() - 1);
  return speed_ < 0 ? time_s <= start_s() : time_s >= end_s();
}

void AnimationClock::play(Wall now) {
  playing_ = true;
  anchor_ = now;
  if (is_over(now)) anchor_s_ = speed_ < 0 ? frame_time_s(frames() - 1) : start_s();
}

void AnimationClock::pause(Wall now) {
  seek(now, time_at(now));
  playing_ = false;
}

void AnimationClock::seek(Wall now, double time_s) {
  anchor_s_ = std::clamp(time_s, start_s(), std::max(start_s(), end_s()));
  anchor_ = now;
}

void AnimationClock::set_held(Wall now, bool held) {
  if (held == held_) return;
  seek(now, time_at(now));
  held_ = held;
}

void AnimationClock::set_speed(Wall now, double speed) {
  seek(now, time_at(now));
  speed_ = std::clamp(speed, -fastest_speed, fastest_speed);
}

void AnimationClock::set_loop(Wall now, bool loop) {
  seek(now, time_at(now));
  loop_ = loop;
}

void AnimationClock::set_fixed_step(Wall now, bool fixed_step) {
  seek(now, time_at(now));
  fixed_step_ = fixed_step;
  if (fixed_step) anchor_s_ = frame_time_s(frame_of(anchor_s_));
}

int AnimationClock::wrapped(int frame) const {
  const int count = frames();
  return loop_ ? (frame % count + count) % count : std::clamp(frame, 0, count - 1);
}

void AnimationClock::step(Wall now, int frames) {
  pause(now);
  const int frame = frame_of(anchor_s_);
  const bool between = frame_time_s(frame) < anchor_s_;
  anchor_s_ = frame_time_s(wrapped(frame + frames + (between && frames < 0 ? 1 : 0)));
}

void AnimationClock::advance_frame() {
  anchor_s_ = frame_time_s(wrapped(frame_of(anchor_s_) + (speed_ < 0 ? -1 : 1)));
}

bool AnimationClock::operator==(const AnimationClock& other) const {
  return timing_.start_s == other.timing_.start_s && timing_.end_s == other.timing_.end_s &&
         timing_.frame_count == other.timing_.frame_count && fps_ == other.fps_ &&
         playing_ == other.playing_ && loop_ == other.loop_ && fixed_step_ == other.fixed_step_ &&
         held_ == other.held_ && speed_ == other.speed_ && anchor_s_ == other.anchor_s_ &&
         anchor_ == other.anchor_;
}

}  // namespace tenebra::viewer
