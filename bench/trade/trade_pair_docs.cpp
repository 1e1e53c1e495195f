#include "bench/trade/trade_pair_docs.h"

#include <fmt/core.h>

#include <algorithm>

namespace tenebra::bench {
namespace {

/// The rows of one stage on one view: one for each number of threads.
template <class Row>
using Group = std::vector<const Row*>;

/// In the order of their first rows.
template <class Row>
std::vector<Group<Row>> grouped(const std::vector<Row>& rows) {
  std::vector<Group<Row>> groups;
  for (const Row& row : rows) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group<Row>& group) {
      return group.front()->stage == row.stage && group.front()->view == row.view;
    });
    (same == groups.end() ? groups.emplace_back() : *same).push_back(&row);
  }
  return groups;
}

/// "9.06 / 5.21": of each number of threads.
template <class Row, class Text>
std::string each(const Group<Row>& group, const Text& text) {
  std::string all;
  for (const Row* row : group) all += (all.empty() ? "" : " / ") + text(*row);
  return all;
}

/// How long the frame takes without each stage, over all views.
std::string stages_summary(const std::vector<StageRow>& stages) {
  struct Ratios {
    std::string stage;
    int threads;
    std::vector<double> values;
  };
  std::vector<Ratios> all;
  for (const StageRow& s : stages) {
    auto of = std::find_if(all.begin(), all.end(),
                           [&](const Ratios& r) { return r.stage == s.stage && r.threads == s.threads; });
    if (of == all.end()) of = all.insert(of, {s.stage, s.threads, {}});
    of->values.push_back(s.without_ms / s.ms);
  }
  std::string text =
      "| stage | threads | time without it over time with it | saves a twentieth or more on |\n"
      "|---|---|---|---|\n";
  for (const auto& [stage, threads, values] : all) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    text += fmt::format("| {} | {} | {:.2f} to {:.2f} | {} of {} views |\n", stage, threads, *least, *most,
                        std::count_if(values.begin(), values.end(), [](double r) { return r >= 1.05; }),
                        values.size());
  }
  return text + "\n";
}

/// Bold where the stage makes the frame a twentieth quicker or slower.
std::string without_text(const StageRow& s) {
  const bool matters = s.without_ms > 1.05 * s.ms || s.without_ms < 0.95 * s.ms;
  return fmt::format("{0}{1}{0}", matters ? "**" : "", short_number(s.without_ms));
}

template <class Row>
bool all_same(const Group<Row>& group) {
  return std::all_of(group.begin(), group.end(), [](const Row* row) { return row->same.value_or(true); });
}

}  // namespace

std::string stages_section(const std::string& measured_by, const std::vector<StageRow>& stages) {
  std::string text =
      fmt::format("## {}\n\n{}", stages_title, measured_by) +
      "With `--quick` 256x256 pixels, else 1024x1024. Whole frames by the program's renderer, hard "
      "shadows unless the row says otherwise: as it draws them, and with this stage alone switched off or "
      "done in full. Times of one thread / of all. MB: what the renderer and its frames hold at most, on "
      "one thread. Same bits: of the picture, where that is promised. knot: a mesh that stands still, "
      "without a light or texture of its own.\n\n" +
      stages_summary(stages) +
      "Early accept and the second pass run only in the paper's variants that are named after them. Bold: "
      "more than 5 % slower or quicker without.\n\n"
      "| stage | view | ms | without | MB | without | same bits |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Group<StageRow>& group : grouped(stages)) {
    const StageRow& s = *group.front();
    text += fmt::format("| {} | {} | {} | {} | {:.0f} | {:.0f} | {} |\n", s.stage, s.view,
                        each(group, [](const StageRow& row) { return short_number(row.ms); }),
                        each(group, without_text), s.mb, s.without_mb,
                        s.same ? all_same(group) ? "yes" : "NOT the same bits" : "not promised");
  }
  return text + "\n";
}

std::string needs_section(const std::string& measured_by, const std::vector<NeedRow>& needs) {
  std::string text =
      fmt::format("## {}\n\n{}", needs_title, measured_by) +
      "The cost of stages that do only what the frame needs, and what they would cost if they did all of "
      "it. Times of one thread / of all. Where both were run, both gave the same bits, or the row says "
      "that they did not; rows without times only count. (Behind shafts only the dark points are "
      "compared: at the others rays are as noisy as without.) Tests check the same: "
      "`tests/render/needs_test.cpp`.\n\n"
      "| stage | view | ms | all, ms | what is left |\n"
      "|---|---|---|---|---|\n";
  for (const Group<NeedRow>& group : grouped(needs)) {
    const NeedRow& n = *group.front();
    const bool timed = n.all_ms > 0;
    text +=
        fmt::format("| {} | {} | {} | {} | {}{} |\n", n.stage, n.view,
                    timed ? each(group, [](const NeedRow& row) { return short_number(row.with_ms); }) : "",
                    timed ? each(group, [](const NeedRow& row) { return short_number(row.all_ms); }) : "",
                    n.shrunk, all_same(group) ? "" : " (NOT the same bits)");
  }
  return text +
         "\n"
         "Where `ms` is not below `all`, the stage saves nothing on that view. Boxes, order, tiles, "
         "fields and whole frames are timed by the clock.\n";
}

}  // namespace tenebra::bench
