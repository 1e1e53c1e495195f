// From the state of the window to what its worker is asked for. Pure.
#pragma once

#include <optional>
#include <vector>

#include "window/frames/trade_search.h"
#include "window/view_state.h"

namespace tenebra::viewer {

/// What `state` wants to see in `place` pixels, but for its number. `record`: each picture is written.
FrameRequest view_request(const ViewState& state, Size place, const std::optional<OutputPattern>& record,
                          AnimationClock::Wall now);

/// Equal where pictures are made in the same way: their times and logs belong together.
struct MethodKey {
  int active = 0;
  bool compare = false;
  Size place;
  std::vector<MethodOptions> methods;  ///< those that are drawn
  Overlay overlay = Overlay::none;

  bool operator==(const MethodKey&) const = default;
};

/// Equal where the same picture is wanted.
struct RequestKey {
  MethodKey method;
  ViewKey view;
  AnimationClock clock;

  bool operator==(const RequestKey&) const = default;
};
/// Equal where a search among settings would try the same ones on the same picture.
TradeSubject trade_subject(const ViewState& state, Size place, AnimationClock::Wall now);
RequestKey request_key(const ViewState& state, Size place);

}  // namespace tenebra::viewer
