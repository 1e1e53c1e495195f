// When the window is drawn and brought to the screen: soon where something changes, rarely where software
// OpenGL would take the processors of a picture that is about to come. Pure arithmetic.
#pragma once

#include <algorithm>
#include <cstdint>

#include "window/motion/animation_clock.h"

namespace tenebra::viewer {

class DrawPace {
public:
  using Wall = AnimationClock::Wall;

  /// The window draws at least this many more frames: Dear ImGui takes a frame or two to settle.
  void ask(int frames) { due_ = std::max(due_, frames); }
  void input_came() {
    ask(3);
    input_undrawn_ = true;
  }
  void picture_came() {
    ++pictures_;
    ask(1);
  }
  std::uint64_t pictures() const { return pictures_; }
  bool is_due() const { return due_ > 0; }
  double since_drawn_s(Wall now) const;

  /// `settles`: some of the user's input is not drawn yet.
  void begin_draw(bool settles, Wall now);
  void end_draw();

  /// Whether what was drawn last is to be brought to the screen. Where a picture is about to come (`hurries`)
  /// it waits for that, unless it is `wanted` or has waited for long.
  bool wants_presenting(bool wanted, bool hurries, Wall now) const;
  /// What the screen shows since now.
  struct Presented {
    std::uint64_t picture = 0;  ///< number of the picture
    bool new_picture = false;   ///< for the first time
    bool newest = false;        ///< no picture has come since
    bool inputs = false;        ///< the effect of new input, for the first time
  };
  Presented presented();

  /// What the worker does, and what moves by itself.
  struct Stir {
    bool hurries = false;     ///< a picture within the time for previews is about to come
    bool moves = false;       ///< progress or messages
    double look_again_s = 0;  ///< when the worker is to be looked at
  };
  /// How long to wait for events at most.
  double sleep_s(const Stir& stir, Wall now) const;

private:
  int due_ = 3;  // frames of the window to draw
  bool input_undrawn_ = false;
  bool unpresented_ = false;  // something is drawn and not on the screen
  std::uint64_t pictures_ = 0;
  std::uint64_t drawn_ = 0;  // of pictures_, by the last draw
  std::uint64_t shown_ = 0;  // of pictures_, on the screen
  Wall last_draw_{};
  Wall unpresented_since_{};  // the first draw after the last that is on the screen
};

}  // namespace tenebra::viewer
