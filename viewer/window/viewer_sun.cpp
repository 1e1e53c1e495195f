// The sun's day: its suns, and the hours that pixels see of them, counted anew where the view or the day
// changes.
#include "window/viewer.h"

namespace tenebra::viewer {
namespace {

constexpr double progress_redraw_s = 0.25;

}  // namespace

std::shared_ptr<const CountedSun> Viewer::shown_hours() const {
  const auto counted = counter_.status().found;
  const bool fits = counted && state_.sun.colours && picture_ &&
                    same_hours(*counted->asked.picture, *picture_) &&
                    same_suns(counted->asked.day, state_.sun);
  return fits ? counted : nullptr;
}

void Viewer::follow_sun() {
  const SunDay& day = state_.sun;
  if (!day.open && !day.colours)
    suns_.reset();
  else if (!suns_ || !same_suns(day, suns_of_))
    suns_ = std::make_shared<sun::Suns>(suns_of_day(day)), suns_of_ = day;
  answers_.explain_suns(day.open ? suns_ : nullptr);

  const bool rests =
      picture_ && picture_->preview.empty() && picture_->scene == state_.scene && !state_.clock.playing();
  if (!day.colours) {
    if (counts_) counter_.stop();
    counting_.reset();
  } else if (rests) {
    const bool begun = counting_ && counting_->suns == suns_ && same_hours(*counting_->picture, *picture_);
    if (!begun) {
      counter_.begin(*(counting_ = SunQuestion{picture_, day, suns_}));
      counts_ = true;
      report_.note("sun", "begun");
    }
  }
  if (const std::string failure = counter_.take_failure(); !failure.empty())
    say(failure, true), state_.sun.colours = false;
  if (counts_ && pace_.since_drawn_s(now()) > progress_redraw_s) pace_.ask(1);
  if (!counts_ || counter_.status().running) return;
  counts_ = false;
  report_.note("sun", "over");
  pace_.ask(3);
}

}  // namespace tenebra::viewer
