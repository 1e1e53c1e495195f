// The sun's day: its suns, and the hours that pixels see of them, counted anew where the view or the day
// changes.
#include "window/viewer.h"

namespace tenebra::viewer {
namespace {

constexpr double progress_redraw_s = 0.25;
/// Without a change for this long the view rests.
constexpr double count_after_s = 0.1;

/// The hours of one fit what the other shows, perhaps in another size.
bool shows_same(const Picture& a, const Picture& b) {
  return same_place(a, b) && same_casters(a, b);
}

}  // namespace

std::shared_ptr<const CountedSun> Viewer::shown_hours() const {
  if (!state_.sun.colours || !picture_) return nullptr;
  const auto counted = counter_.status().found;
  const bool fits =
      counted && shows_same(*picture_, *counted->asked.picture) && same_suns(counted->asked.day, state_.sun);
  return fits ? counted : nullptr;
}

void Viewer::count_hours() {
  will_count_ = false;
  if (!state_.sun.colours) {
    if (counting_) counter_.forget();
    return counting_.reset();
  }
  if (!picture_ || picture_->scene != state_.scene) return;
  const bool same_day = counting_ && counting_->suns == suns_;
  if (counting_ && !(same_day && shows_same(*picture_, *counting_->picture))) {
    counter_.stop();
    counting_.reset();
  }
  if (state_.clock.playing() || (counting_ && same_hours(*picture_, *counting_->picture))) return;
  will_count_ = true;
  const double unchanged_s = std::chrono::duration<double>(now() - changed_).count();
  if (hand_moves_ || unchanged_s < count_after_s || !picture_->preview.empty() || worker_.status().drawing)
    return;
  counter_.begin(*(counting_ = SunQuestion{picture_, state_.sun, suns_}));
  counts_ = true, will_count_ = false;
  report_.note("sun", "begun");
}

void Viewer::follow_sun() {
  const SunDay& day = state_.sun;
  if (!day.open && !day.colours)
    suns_.reset();
  else if (!suns_ || !same_suns(day, suns_of_))
    suns_ = std::make_shared<sun::Suns>(suns_of_day(day)), suns_of_ = day, changed_ = now();
  answers_.explain_suns(day.open ? suns_ : nullptr);

  count_hours();
  if (const std::string failure = counter_.take_failure(); !failure.empty())
    say(failure, true), state_.sun.colours = false;
  if (counts_ && pace_.since_drawn_s(now()) > progress_redraw_s) pace_.ask(1);
  if (!counts_ || counter_.status().running) return;
  counts_ = false;
  report_.note("sun", "over");
  pace_.ask(3);
}

}  // namespace tenebra::viewer
