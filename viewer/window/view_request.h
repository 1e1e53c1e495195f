// From the state of the window to what its worker is asked for. Pure.
#pragma once

#include <optional>
#include <string>

#include "window/view_state.h"

namespace tenebra::viewer {

/// What `state` wants to see in `place` pixels, but for its number. `record`: each picture is written.
FrameRequest view_request(const ViewState& state, Size place, const std::optional<OutputPattern>& record,
                          AnimationClock::Wall now);

/// Equal where the same picture is wanted.
struct RequestKey {
  std::string method;  ///< settings: their times and logs belong together
  std::string view;    ///< scene, camera, edits
  AnimationClock clock;

  bool operator==(const RequestKey&) const = default;
};
/// Equal where a search among settings would try the same ones on the same picture.
std::string trade_subject(const ViewState& state, Size place, AnimationClock::Wall now);
RequestKey request_key(const ViewState& state, Size place);

}  // namespace tenebra::viewer
