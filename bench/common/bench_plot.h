// Plots as SVG: curves over a variable, and bars by category. Plain files that a browser shows; no
// dependency.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tenebra::bench {

struct Axis {
  std::string label;         ///< with its unit: "time (s)"
  bool logarithmic = false;  ///< values that are not positive are left out
};

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< drawn in this order
};

/// Curves with markers, a legend and ticks at round numbers; a linear axis starts at 0 where no value is
/// negative.
std::string curve_plot(const std::string& title, const Axis& x, const Axis& y,
                       const std::vector<Curve>& curves);

/// Points of several families on logarithmic axes, and a dashed line through those of `front`, which are
/// ringed. What is not above `floor` lies on a line of its own at the foot.
std::string scatter_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                         double floor, const std::vector<Curve>& families, const Curve& front);

struct Bars {
  std::string name;
  std::vector<double> values;  ///< one per category
};

/// Groups of bars side by side (`stacked`: one above the other), the value written above each.
std::string bar_plot(const std::string& title, const Axis& y, const std::vector<std::string>& categories,
                     const std::vector<Bars>& bars, bool stacked = false);

}  // namespace tenebra::bench
