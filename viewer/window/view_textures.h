// The newest picture as textures: A, B, their difference, the overlay.
#pragma once

#include <tuple>

#include "window/frames/frame_request.h"
#include "window/frames/sun_counter.h"
#include "window/view_state.h"
#include "window/window_gl.h"

namespace tenebra::viewer {

class ViewTextures {
public:
  explicit ViewTextures(WindowGl& gl) : a(gl), b(gl), difference(gl), overlay(gl), hours(gl) {}

  /// Uploads what `state` shows of `picture`, if that has changed; `exact`: it is shown pixel by pixel.
  void show(const std::shared_ptr<const Picture>& picture, const ViewState& state, bool exact) {
    const auto shown = std::tuple(picture, state.show, state.gain, exact);
    if (shown == shown_) return;
    shown_ = shown;
    a.show(picture->a.result.image, !exact);
    if (picture->b) b.show(picture->b->result.image, !exact);
    if (picture->b && state.show == CompareView::difference) {
      difference.show(absolute_difference(picture->a.result.image, picture->b->result.image, state.gain),
                      !exact);
    }
    if (picture->overlay.kind != Overlay::none) overlay.show(picture->overlay.image, !exact);
  }

  /// The same of hours of sun.
  void show_hours(const std::shared_ptr<const CountedSun>& counted) {
    if (counted == hours_) return;
    hours_ = counted;
    if (counted) hours.show(counted->image, false);
  }

  PictureTexture a, b, difference, overlay, hours;

private:
  std::tuple<std::shared_ptr<const Picture>, CompareView, int, bool> shown_;
  std::shared_ptr<const CountedSun> hours_;
};

}  // namespace tenebra::viewer
