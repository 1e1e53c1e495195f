// Runs of query points, each a picture that the tracers take.
#pragma once

#include <algorithm>
#include <cstddef>

#include <tenebra/queries.h>
#include "base/fail.h"
#include "parallel/parallel.h"
#include "points/sample_points.h"

namespace tenebra::query {

/// Points [first, first + count), as rows of a picture or as a list.
class Portion {
public:
  static constexpr std::size_t most = std::size_t{1} << 18;  ///< points; more if rows are very long
  static constexpr std::size_t run = 4096;                   ///< points that each_run passes at most

  /// The portion that begins with point `first` of `points`, which has more than `first`.
  Portion(const QueryPoints& points, std::size_t first)
      : first_(first), columns_(static_cast<std::size_t>(points.width)), list_(0) {
    constexpr std::size_t rows_of_squares = 16;
    const std::size_t left = points.positions.size() - first;
    if (columns_ == 0) {
      count_ = std::min(left, most);
      list_ = points::SampleGrid(count_);
    } else {
      const std::size_t rows = std::max(most / columns_ / rows_of_squares * rows_of_squares, rows_of_squares);
      count_ = std::min(left, rows * columns_);
    }
  }

  std::size_t first() const { return first_; }
  std::size_t count() const { return count_; }
  int width() const { return columns_ == 0 ? list_.width() : static_cast<int>(columns_); }
  int height() const { return columns_ == 0 ? list_.height() : static_cast<int>(count_ / columns_); }
  std::size_t pixels() const { return columns_ == 0 ? list_.pixels() : count_; }
  /// Where the portion's point `i` stands.
  std::size_t pixel(std::size_t i) const { return columns_ == 0 ? list_.pixel(i) : i; }

private:
  std::size_t first_, columns_, count_ = 0;
  points::SampleGrid list_;
};

/// Calls body(first, last) for runs of a portion's points, on several threads.
template <class Body>
void each_run(const Portion& portion, const Body& body) {
  parallel::parallel_ranges(portion.count(), Portion::run, body);
}
/// Calls body(i, pixel) for the points i of a portion, likewise.
template <class Body>
void each_point(const Portion& portion, const Body& body) {
  each_run(portion, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i, portion.pixel(i));
  });
}

/// Calls answer(portion) for one portion after the other, until one fails or all are done.
template <class Answer>
Expected<void> in_portions(const QueryPoints& points, const StopFlag* stop, const QueryProgress& progress,
                           const Answer& answer) {
  const std::size_t count = points.positions.size();
  for (std::size_t first = 0; first < count;) {
    const Portion portion(points, first);
    if (stop_requested(stop)) return base::stopped();
    if (Expected<void> done = answer(portion); !done) return done;
    first += portion.count();
    if (progress) progress(static_cast<double>(first) / static_cast<double>(count));
  }
  return {};
}

}  // namespace tenebra::query
