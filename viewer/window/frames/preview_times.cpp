#include "window/frames/preview_times.h"

#include <algorithm>
#include <cmath>

namespace tenebra::viewer {
namespace {

// Before a level has been drawn its time is guessed from one that has. Wrong guesses cost one picture: it is
// stopped when it takes too long, and from then on its own time counts.
constexpr double cost_of_halving = 3;  // of the divisor; four times the pixels, but not of all work
constexpr double cost_of_method[] = {18, 10, 2.5, 3, 1};  // of PreviewMethod, beside `plain`

constexpr double room = 0.8;          // of the budget, for a level finer than the last
constexpr double newest_share = 0.5;  // of the newest time in a level's
constexpr double first_share = 0.7;   // of the first time, in which buffers are made
constexpr double forgetting = 0.995;  // per picture: what was too slow once is tried again after a while
// The share of the whole picture's time that steps on the way to it may take: a quick one, and the last with
// one sample per pixel.
constexpr double refining_part = 0.2, single_part = 0.6;

double cost(PreviewLevel level) {
  return cost_of_method[static_cast<std::size_t>(level.method)] *
         std::pow(cost_of_halving, -std::log2(static_cast<double>(level.divisor)));
}

}  // namespace

PreviewTimes::PreviewTimes(const PreviewSubject& subject)
    : levels_(preview_levels(subject)), known_(levels_.size()) {}

double PreviewTimes::estimate_ms(int level) const {
  const auto index = static_cast<std::size_t>(level);
  if (known_[index].ms > 0) return known_[index].ms;
  double least_ms = 0;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!(known_[i].ms > 0)) continue;
    const double ms = known_[i].ms * cost(levels_[index]) / cost(levels_[i]);
    if (least_ms == 0 || ms < least_ms) least_ms = ms;
  }
  return least_ms;
}

int PreviewTimes::choose(double budget_ms) {
  const auto usable = [&](int level) { return known_[static_cast<std::size_t>(level)].usable; };
  const bool known = std::any_of(known_.begin(), known_.end(), [](const Known& k) { return k.ms > 0; });
  if (!known) return last_ = std::max(0, coarsest() - 1);  // something quick
  for (int level = 0; level < coarsest(); ++level) {
    const double limit_ms = level < last_ ? room * budget_ms : budget_ms;
    if (usable(level) && estimate_ms(level) <= limit_ms) return last_ = level;
  }
  return last_ = coarsest();
}

int PreviewTimes::refine(int shown) const {
  const double whole_ms = estimate_ms(0);
  for (int level = 1; level < shown; ++level) {
    const Known& known = known_[static_cast<std::size_t>(level)];
    if (known.usable && estimate_ms(level) <= refining_part * whole_ms) return level;
  }
  const bool single = levels_[1] == PreviewLevel{PreviewMethod::single, 1};
  return single && shown > 1 && estimate_ms(1) <= single_part * whole_ms ? 1 : 0;
}

void PreviewTimes::drew(int level, double ms) {
  Known& known = known_[static_cast<std::size_t>(level)];
  known.ms = known.ms > 0 ? newest_share * ms + (1 - newest_share) * known.ms : first_share * ms;
  for (Known& other : known_) {
    if (&other != &known && other.ms > known.ms) other.ms = std::max(known.ms, forgetting * other.ms);
  }
}

void PreviewTimes::overran(int level, double ms) {
  // It would have taken longer still; how much is not known.
  Known& known = known_[static_cast<std::size_t>(level)];
  known.ms = std::max(known.ms, 2 * ms);
}

void PreviewTimes::failed(int level) {
  known_[static_cast<std::size_t>(level)].usable = false;
}

PreviewTimes& PreviewMemory::of(const PreviewSubject& subject) {
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const Entry& entry) { return entry.subject == subject; });
  if (found == kept_.end()) {
    if (kept_.size() == capacity) kept_.pop_back();
    kept_.push_front({subject, PreviewTimes(subject)});
  } else if (found != kept_.begin()) {
    std::rotate(kept_.begin(), found, found + 1);
  }
  return kept_.front().times;
}

}  // namespace tenebra::viewer
