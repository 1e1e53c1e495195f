// The search for settings that are worth their time on what is shown.
#include "window/viewer.h"

namespace tenebra::viewer {
namespace {

constexpr double redraw_s = 0.5;  // of its progress: drawing takes the search's processors

}  // namespace

void Viewer::toggle_trade() {
  if (search_.status().running) return search_.stop();
  if (!state_.scene || place_.width < 1) return;
  if (recording_.is_on()) return say("A recording is under way.");
  state_.clock.pause(now());
  FrameRequest request = view_request(state_, place_, std::nullopt, now());
  request.a = render_settings(state_.method(), place_, state_.display);
  search_.begin({std::move(request), trade_subject(state_, place_, now())});
}

void Viewer::follow_search() {
  const TradeStatus status = search_.status();
  if (const std::string failure = search_.take_failure(); !failure.empty()) say(failure, true);
  if (status.running && pace_.since_drawn_s(now()) > redraw_s) pace_.ask(1);
  if (status.running == searches_) return;
  searches_ = status.running;
  report_.note("search", searches_ ? "begun" : "over");
  pace_.ask(3);
}

}  // namespace tenebra::viewer
