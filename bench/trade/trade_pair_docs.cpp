#include "bench/trade/trade_pair_docs.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace tenebra::bench {
namespace {

/// What was measured of one stage: a row for each view and number of threads.
template <class Row>
struct StageRows {
  std::vector<const Row*> rows;

  const Row& first() const { return *rows.front(); }
  std::size_t views() const {
    std::set<std::string> names;
    for (const Row* row : rows) names.insert(row->view);
    return names.size();
  }
  bool all_same() const {
    return std::all_of(rows.begin(), rows.end(), [](const Row* row) { return row->same.value_or(true); });
  }
};

/// In the order of their first rows.
template <class Row>
std::vector<StageRows<Row>> by_stage(const std::vector<Row>& rows) {
  std::vector<StageRows<Row>> stages;
  for (const Row& row : rows) {
    const auto same = std::find_if(stages.begin(), stages.end(), [&](const StageRows<Row>& stage) {
      return stage.first().stage == row.stage;
    });
    (same == stages.end() ? stages.emplace_back() : *same).rows.push_back(&row);
  }
  return stages;
}

/// The ratios of two times over the views, by the number of threads; rows without times are left out.
template <class Row>
std::map<int, std::vector<double>> ratios(const StageRows<Row>& stage, double Row::*over,
                                          double Row::*under) {
  std::map<int, std::vector<double>> all;
  for (const Row* row : stage.rows)
    if (row->*under > 0) all[row->threads].push_back(row->*over / row->*under);
  return all;
}

/// "1.16 to 1.36/1.15 to 1.50": least and most on each number of threads.
std::string ranges(const std::map<int, std::vector<double>>& ratios) {
  std::string text;
  for (const auto& [threads, values] : ratios) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const std::string from = short_number(*least), to = short_number(*most);
    text += (text.empty() ? "" : "/") + (from == to ? from : from + " to " + to);
  }
  return text;
}

}  // namespace

std::string stages_section(const std::string& measured_by, const std::vector<StageRow>& stages) {
  std::string text =
      fmt::format("## {}\n\n{}", stages_title, measured_by) +
      "With `--quick` 256x256 pixels, else 1024x1024. Whole frames by the program's renderer, hard shadows "
      "unless the row says otherwise: the time with this stage alone switched off or done in full, over the "
      "time of the frame as it is drawn, on one thread/on all, least and most of the views (one is a mesh "
      "that stands still, without a light or texture of its own). Same bits: of the picture, where that is "
      "promised. `--csv` has the single views, with their memory.\n\n"
      "| stage | time without it over time with it | saves a twentieth or more on | same bits |\n"
      "|---|---|---|---|\n";
  for (const StageRows<StageRow>& stage : by_stage(stages)) {
    const auto all = ratios(stage, &StageRow::without_ms, &StageRow::ms);
    const auto& of_one = all.begin()->second;
    text += fmt::format("| {} | {} | {} of {} views | {} |\n", stage.first().stage, ranges(all),
                        std::count_if(of_one.begin(), of_one.end(), [](double r) { return r >= 1.05; }),
                        stage.views(),
                        !stage.all_same()     ? "NOT the same bits"
                        : !stage.first().same ? "not promised"
                                              : "yes");
  }
  return text +
         "\n"
         "Early accept and the second pass run only in the paper's variants that are named after them.\n\n";
}

std::string needs_section(const std::string& measured_by, const std::vector<NeedRow>& needs) {
  std::string text =
      fmt::format("## {}\n\n{}", needs_title, measured_by) +
      "The time of stages that do only what the frame needs, over what they would take if they did all of "
      "it, on one thread/on all, least and most of the views; and what is left on one of them. Where both "
      "were run, both gave the same bits, or the row says that they did not. What is only counted is left to "
      "`--csv`. "
      "(Behind shafts only the dark points are compared: at the others rays are as noisy as without.) Tests "
      "check the same: `tests/render/needs_test.cpp`.\n\n"
      "| stage | time over that of all of it | what is left |\n"
      "|---|---|---|\n";
  for (const StageRows<NeedRow>& stage : by_stage(needs)) {
    const auto times = ratios(stage, &NeedRow::with_ms, &NeedRow::all_ms);
    if (times.empty() && stage.all_same()) continue;
    text += fmt::format("| {} | {} | {}: {}{} |\n", stage.first().stage, ranges(times), stage.first().view,
                        stage.first().shrunk, stage.all_same() ? "" : " (NOT the same bits)");
  }
  return text +
         "\n"
         "Boxes, order, tiles, fields and whole frames are timed by the clock.\n";
}

}  // namespace tenebra::bench
