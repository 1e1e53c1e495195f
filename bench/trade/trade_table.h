// What accuracy costs: settings of one method on one view as points (time, error), the Pareto front among
// them, and how they are presented: figures, tables, plots.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/common/bench_report.h"
#include "io/image.h"

namespace tenebra::bench {

/// How long a frame takes.
struct TradeTime {
  int threads = 1;
  double ms = 0;
  bool front = false;  ///< on this many threads no other is both as fast and as exact, and better in one
};

/// One setting.
struct TradePoint {
  std::string family;            ///< "shadow map": settings of one family are one curve
  std::string setting;           ///< "1024": with the family a name
  std::vector<TradeTime> times;  ///< not empty; of all points of a table on the same numbers of threads
  std::vector<double> errors;    ///< one per column of the table; the first is the one of the plot
  double mb = 0;                 ///< memory that it takes at most

  double ms() const { return times.front().ms; }

  std::string name() const { return setting.empty() ? family : family + ", " + setting; }
};

/// Pieces of pictures side by side, and what they are from the left on.
struct TradeCrops {
  io::Image8 image;
  std::string caption;
};

struct ErrorColumn {
  std::string name;  ///< "wrong pixels"
  std::string unit;  ///< "1/255"; empty: a count
};

/// All settings of a method on one view.
struct TradeTable {
  std::string method;  ///< "hard"
  std::string view;    ///< "robots 100"
  std::vector<ErrorColumn> columns;
  std::vector<TradePoint> points;
  double none_below = 0;  ///< first errors up to this count as none: beneath what the method promises
  std::string remark{};   ///< what a reader of the table has to know of this view, a sentence; may be empty
  std::optional<TradeCrops> crops{};

  /// The setting of that name; null where it was not measured.
  const TradePoint* find(const std::string& name) const;
};

/// "2 threads"
std::string threads_text(int threads);
/// "hard shadows" of "hard".
std::string method_title(const std::string& method);

/// Sets TradeTime::front by time and the first error; errors up to `none_below` are all alike.
void mark_front(std::vector<TradePoint>& points, double none_below);

/// Time, errors and "front" of each setting, as experiment "trade METHOD".
void add_figures(const TradeTable& table, Report& report);

/// The settings from the fastest to the slowest; times on the front with a star.
std::string trade_text(const TradeTable& table);

/// Time on x (of the fewest threads), the first error on y, both logarithmic; the front is a line, what has
/// no error lies at the foot.
std::string trade_plot(const TradeTable& table);
/// "hard_robots_100"
std::string plot_name(const TradeTable& table);

/// A number with as many digits as a reader needs: three.
std::string short_number(double value);

}  // namespace tenebra::bench
