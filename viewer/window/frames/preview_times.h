// Which preview fits into the time for previews, by what the last ones took. It reads no clock: times are
// passed in.
#pragma once

#include <deque>
#include <vector>

#include "window/frames/preview_levels.h"

namespace tenebra::viewer {

/// Times of the levels of one subject. Levels are numbers into preview_levels: 0 is the whole picture.
class PreviewTimes {
public:
  explicit PreviewTimes(const PreviewSubject& subject);

  const std::vector<PreviewLevel>& levels() const { return levels_; }
  int coarsest() const { return static_cast<int>(levels_.size()) - 1; }

  /// The finest level that is likely to take at most `budget_ms`; the coarsest where none is. To become finer
  /// than the last one it must fit with room to spare, so that the choice does not swing.
  int choose(double budget_ms);
  /// What is drawn next where nothing hurries and `shown` is in the window: the whole picture, or on the way
  /// to it a level that takes a small part of its time.
  int refine(int shown) const;

  void drew(int level, double ms);
  /// It was stopped after `ms`, for it took too long: the next choice is a coarser one.
  void overran(int level, double ms);
  void failed(int level);  ///< never to be tried again

  /// Milliseconds that the level is likely to take; 0 where nothing is known.
  double estimate_ms(int level) const;

private:
  struct Known {
    double ms = 0;  ///< 0: never drawn
    bool usable = true;
  };
  std::vector<PreviewLevel> levels_;
  std::vector<Known> known_;
  int last_ = -1;  // that was chosen; none yet
};

/// The times of the last few subjects, so that those of both methods are known when a user flips between two.
class PreviewMemory {
public:
  PreviewTimes& of(const PreviewSubject& subject);
  void clear() { kept_.clear(); }

private:
  struct Entry {
    PreviewSubject subject;
    PreviewTimes times;
  };
  static constexpr std::size_t capacity = 8;
  std::deque<Entry> kept_;  // the last used first
};

}  // namespace tenebra::viewer
