// Where the animation is: driven by the wall clock, or by one frame for each picture. A value: the render
// worker plays its own copy.
#pragma once

#include <chrono>

#include <tenebra/animation.h>

namespace tenebra::viewer {

inline constexpr double fastest_speed = 4.0;  ///< and backwards as fast

class AnimationClock {
public:
  using Wall = std::chrono::steady_clock::time_point;

  /// Paused, at the start of `clip`; nullptr: a scene without animation, one frame at time 0.
  explicit AnimationClock(const Clip* clip = nullptr, double fps = 30.0);

  double start_s() const { return timing_.start_s; }
  double end_s() const { return timing_.end_s; }
  int frames() const;
  double frame_time_s(int frame) const;  ///< the same bits as `tenebra render --frames`
  int frame_of(double time_s) const;     ///< last frame that is not after `time_s`

  bool playing() const { return playing_; }
  bool held() const { return held_; }
  bool runs() const { return playing_ && !held_; }
  double speed() const { return speed_; }
  bool loop() const { return loop_; }
  bool fixed_step() const { return fixed_step_; }

  /// Seconds within start_s() .. end_s(). Does not move while fixed_step() or held().
  double time_at(Wall now) const;
  /// Playing has come to the last moment there is, and does not loop.
  bool is_over(Wall now) const;

  void play(Wall now);  ///< from the other end if it is over
  void pause(Wall now);
  void seek(Wall now, double time_s);
  void set_held(Wall now, bool held);      ///< while held it does not move, and playing goes on afterwards
  void set_speed(Wall now, double speed);  ///< clamped to -4 .. 4
  void set_loop(Wall now, bool loop);
  void set_fixed_step(Wall now, bool fixed_step);
  void step(Wall now, int frames);  ///< to a whole frame, forwards or backwards, and pauses there
  void advance_frame();             ///< fixed step: the next picture, in the direction of the speed

  bool operator==(const AnimationClock& other) const;

private:
  int wrapped(int frame) const;

  Clip timing_;  // without tracks
  double fps_ = 30.0;
  bool playing_ = false;
  bool loop_ = true;
  bool fixed_step_ = false;
  bool held_ = false;
  double speed_ = 1.0;
  double anchor_s_ = 0;  // the time of the animation when the wall clock showed anchor_
  Wall anchor_{};
};

}  // namespace tenebra::viewer
