// What a measuring command tells: progress on standard error, figures in a CSV file, plots beside it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::bench {

/// "label: text" on standard error at once.
void progress(const std::string& text);

/// One measurement.
struct Figure {
  std::string experiment;  ///< "figure8"
  std::string view;        ///< "robots 100"
  std::string contestant;  ///< "tenebra", "embree"
  std::string parameter;   ///< what was varied and to what: "rays=64"; empty: nothing
  std::string quantity;    ///< "time", "rmse"
  double value = 0;
  std::string unit;  ///< "ms", "1/255", "bytes"; empty: a count or a ratio
};

/// Gathers figures and plots, and writes them together.
class Report {
public:
  /// Nothing is written if `csv` is empty.
  explicit Report(std::filesystem::path csv) : csv_(std::move(csv)) {}

  void add(Figure figure) { figures_.push_back(std::move(figure)); }
  /// To be written as STEM_name.svg beside the CSV.
  void add_plot(std::string name, std::string svg) { plots_.emplace_back(std::move(name), std::move(svg)); }
  std::span<const Figure> figures() const { return figures_; }

  /// Fails early where the CSV could not be written in the end.
  Expected<void> check() const;
  /// The CSV, its head naming the machine and `settings` ("threads: 2"), and the plots.
  Expected<void> write(std::span<const std::string> settings) const;

private:
  std::filesystem::path csv_;
  std::vector<Figure> figures_;
  std::vector<std::pair<std::string, std::string>> plots_;
};

/// Rows of text; the first is the head.
using Rows = std::vector<std::vector<std::string>>;

/// Columns of text, each as wide as its widest entry, numbers to the right.
std::string text_table(const Rows& rows);

/// Prints such a table below its title at once, for those who watch.
void print_table(const std::string& title, const Rows& rows);

/// Geometric mean; 0 for no values or where one is not positive.
double geometric_mean(std::span<const double> values);
double median(std::span<const double> values);

/// A last line that a script reads: "hard.static_worst: 0.40\n"; "not measured" for NaN.
std::string headline(const std::string& name, double value, int digits);

}  // namespace tenebra::bench
