#include "log/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "log/log_summary.h"
#include "log/page_text.h"
#include "log/ticks.h"

namespace tenebra::viewer {
namespace {

// Units of the drawing, which the page scales.
constexpr double width = 960, height = 300, left = 56, right = 12, top = 14, bottom = 40;
constexpr std::size_t most_stages = 9;  // as many colours as can be told apart
constexpr std::size_t most_tips = 1500;

/// The rows of a log by their frames, and the usual distance between two.
struct Rows {
  std::vector<const LoggedFrame*> frames;
  int step = 1;
};

Rows rows_of(const LogFile& log) {
  Rows rows;
  for (const LoggedFrame& frame : log.frames) rows.frames.push_back(&frame);
  std::stable_sort(rows.frames.begin(), rows.frames.end(),
                   [](const LoggedFrame* a, const LoggedFrame* b) { return a->frame < b->frame; });
  int step = 0;
  for (std::size_t i = 1; i < rows.frames.size(); ++i) {
    const int distance = rows.frames[i]->frame - rows.frames[i - 1]->frame;
    if (distance > 0 && (step == 0 || distance < step)) step = distance;
  }
  rows.step = std::max(step, 1);
  return rows;
}

/// From frames and milliseconds to the drawing, with the axes.
struct Axes {
  double first = 0, last = 1;  ///< ends of the animation, half a step beyond the frames
  double highest_ms = 1;

  Axes(double first_frame, double last_frame, double worst_ms) : first(first_frame), last(last_frame) {
    const double step = tick_step(worst_ms * 1.05, 5);
    highest_ms = step * std::ceil(worst_ms * 1.05 / step);
    if (!(highest_ms > 0)) highest_ms = 1;
  }
  double x(double frame) const { return left + (frame - first) / (last - first) * (width - left - right); }
  double y(double ms) const {
    return height - bottom - std::min(ms / highest_ms, 1.0) * (height - top - bottom);
  }

  std::string svg() const {
    std::string text;
    for (const double ms : even_ticks(0, highest_ms * 1.001, tick_step(highest_ms, 5))) {
      text += fmt::format(
          "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
          "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.6g}</text>\n",
          left, width - right, y(ms), y(ms), left - 6, y(ms) + 4, ms);
    }
    for (const double frame : even_ticks(first, last, std::max(1.0, tick_step(last - first, 10)))) {
      text += fmt::format(
          "<line class=\"axis\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
          "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:.0f}</text>\n",
          x(frame), height - bottom, height - bottom + 4, height - bottom + 17, frame);
    }
    text += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">frame</text>\n",
                        (left + width - right) / 2, height - 6);
    return text + fmt::format(
                      "<text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" "
                      "text-anchor=\"middle\">milliseconds per frame</text>\n",
                      (top + height - bottom) / 2);
  }
};

Axes axes_of(std::span<const Rows> all, double worst_ms) {
  double first = 1e300, last = -1e300;
  for (const Rows& rows : all) {
    first = std::min(first, rows.frames.front()->frame - rows.step / 2.0);
    last = std::max(last, rows.frames.back()->frame + rows.step / 2.0);
  }
  return {first, last, worst_ms};
}

std::string open_svg(const std::string& title) {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width, height,
                     page_text(title));
}

/// Calls run(first, end) for each run of frames without a gap.
template <class Run>
void for_each_run(const Rows& rows, Run run) {
  for (std::size_t first = 0; first < rows.frames.size();) {
    std::size_t end = first + 1;
    while (end < rows.frames.size() && rows.frames[end]->frame - rows.frames[end - 1]->frame <= rows.step)
      ++end;
    run(first, end);
    first = end;
  }
}

/// What a reader sees who points at a frame.
std::string tip(const Axes& axes, const Rows& rows, std::size_t i, const std::string& text) {
  const double half = rows.step / 2.0, x = axes.x(rows.frames[i]->frame - half);
  return fmt::format(
      "<rect class=\"tip\" x=\"{:.1f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\"><title>{}</title></rect>\n",
      x, top, axes.x(rows.frames[i]->frame + half) - x, height - top - bottom, page_text(text));
}

std::string line_of(const Axes& axes, const Rows& rows, std::size_t total, std::size_t number) {
  std::string text;
  for_each_run(rows, [&](std::size_t first, std::size_t end) {
    std::string points;
    for (std::size_t i = first; i < end; ++i)
      points +=
          fmt::format("{:.1f},{:.1f} ", axes.x(rows.frames[i]->frame), axes.y(rows.frames[i]->values[total]));
    text += fmt::format("<polyline class=\"line{}\" points=\"{}\"/>\n", number, points);
    if (end - first == 1) {
      text += fmt::format("<circle class=\"dot{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n", number,
                          axes.x(rows.frames[first]->frame), axes.y(rows.frames[first]->values[total]));
    }
  });
  return text;
}

/// First frames, and those that the scale does not hold: the largest of these with its time.
std::string marks_of(const Axes& axes, const Rows& rows, std::size_t total, std::size_t number) {
  std::string text;
  const LoggedFrame* largest = nullptr;
  for (const LoggedFrame* frame : rows.frames) {
    const double ms = frame->values[total], x = axes.x(frame->frame);
    if (ms > axes.highest_ms) {
      if (largest == nullptr || ms > largest->values[total]) largest = frame;
      text += fmt::format("<path class=\"dot{}\" d=\"M{:.1f} {}l5 9h-10z\"/>\n", number, x, top - 6);
    } else if (frame->opens_chunk) {
      text += fmt::format("<circle class=\"ring{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>\n", number, x,
                          axes.y(ms));
    }
  }
  if (largest == nullptr) return text;
  const double x = axes.x(largest->frame);
  const bool is_late = x > width - 120;  // no room to the right
  return text +
         fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\">{:.4g} ms</text>\n",
                     is_late ? x - 8 : x + 8, top + 3 + 13 * static_cast<double>(number),
                     is_late ? "end" : "start", largest->values[total]);
}

std::string stage_name(const LogFile& log, std::size_t column) {
  return log.columns[column].substr(0, log.columns[column].size() - 3);  // without _ms
}

/// Mean of a column, of frames that open no chunk if there are others.
double mean_of(const LogFile& log, std::size_t column) {
  double sum = 0, sum_of_first = 0;
  std::size_t count = 0;
  for (const LoggedFrame& frame : log.frames) {
    (frame.opens_chunk ? sum_of_first : sum) += frame.values[column];
    count += frame.opens_chunk ? 0 : 1;
  }
  return count > 0 ? sum / static_cast<double>(count) : sum_of_first / static_cast<double>(log.frames.size());
}

/// For each frame the upper ends of its stages, one on the other; the last is the whole frame.
std::vector<std::vector<double>> stacks_of(const LogFile& log, const Rows& rows,
                                           const std::vector<std::string>& stages) {
  const std::size_t total = *log.column("total_ms");
  const std::vector<std::size_t> columns = stage_columns(log);
  std::vector<std::size_t> places;
  for (const std::size_t column : columns) {
    const auto found = std::find(stages.begin(), stages.end() - 1, stage_name(log, column));
    places.push_back(static_cast<std::size_t>(found - stages.begin()));
  }
  std::vector<std::vector<double>> stacks;
  for (const LoggedFrame* frame : rows.frames) {
    std::vector<double> ends(stages.size(), 0.0);
    for (std::size_t i = 0; i < columns.size(); ++i) ends[places[i]] += frame->values[columns[i]];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    ends.back() = std::max(ends.back(), frame->values[total]);
    stacks.push_back(std::move(ends));
  }
  return stacks;
}

std::string area_of(const Axes& axes, const Rows& rows, const std::vector<std::vector<double>>& stacks,
                    std::size_t stage) {
  std::string path;
  const double half = rows.step / 2.0;
  for_each_run(rows, [&](std::size_t first, std::size_t end) {
    const auto corner = [&](std::size_t i, double side, double ms) {
      path += fmt::format("{:.1f} {:.1f} ", axes.x(rows.frames[i]->frame + side), axes.y(ms));
    };
    path += "M";
    for (std::size_t i = first; i < end; ++i)
      for (const double side : {-half, half}) corner(i, side, stacks[i][stage]);
    for (std::size_t i = end; i-- > first;)
      for (const double side : {half, -half}) corner(i, side, stage == 0 ? 0.0 : stacks[i][stage - 1]);
    path += "Z";
  });
  return path;
}

}  // namespace

double usual_worst_ms(const LogFile& log) {
  const std::size_t total = *log.column("total_ms");
  const bool all_first =
      std::all_of(log.frames.begin(), log.frames.end(), [](const LoggedFrame& f) { return f.opens_chunk; });
  double worst = 0;
  for (const LoggedFrame& frame : log.frames)
    if (all_first || !frame.opens_chunk) worst = std::max(worst, frame.values[total]);
  return worst;
}

std::string total_chart(std::span<const ChartedLog> logs) {
  std::vector<Rows> all;
  double worst = 0;
  for (const ChartedLog& charted : logs) {
    all.push_back(rows_of(*charted.log));
    worst = std::max(worst, usual_worst_ms(*charted.log));
  }
  const Axes axes = axes_of(all, worst);
  std::string text = open_svg("Milliseconds of whole frames over the animation") + axes.svg();
  for (std::size_t k = 0; k < all.size(); ++k)
    text += line_of(axes, all[k], *logs[k].log->column("total_ms"), k);
  for (std::size_t k = 0; k < all.size(); ++k)
    text += marks_of(axes, all[k], *logs[k].log->column("total_ms"), k);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].frames.size() > most_tips) continue;
    for (std::size_t i = 0; i < all[k].frames.size(); ++i) {
      std::string said = fmt::format("frame {}", all[k].frames[i]->frame);
      for (std::size_t j = 0; j < all.size(); ++j) {
        const auto same = std::find_if(all[j].frames.begin(), all[j].frames.end(), [&](const LoggedFrame* f) {
          return f->frame == all[k].frames[i]->frame;
        });
        if (same != all[j].frames.end())
          said +=
              fmt::format("\n{}: {:.2f} ms", logs[j].name, (*same)->values[*logs[j].log->column("total_ms")]);
      }
      text += tip(axes, all[k], i, said + (all[k].frames[i]->opens_chunk ? "\nfirst of a chunk" : ""));
    }
  }
  return text + "</svg>\n";
}

std::vector<std::string> charted_stages(std::span<const ChartedLog> logs) {
  std::vector<std::string> names;
  std::vector<double> sizes;
  for (const ChartedLog& charted : logs) {
    for (const std::size_t column : stage_columns(*charted.log)) {
      const std::string name = stage_name(*charted.log, column);
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) sizes.push_back(0);
      const auto at = static_cast<std::size_t>(found - names.begin());
      if (found == names.end()) names.push_back(name);
      sizes[at] += mean_of(*charted.log, column);
    }
  }
  std::vector<double> ranked = sizes;
  std::sort(ranked.rbegin(), ranked.rend());
  const double least = ranked.size() > most_stages ? ranked[most_stages] : 0.0;
  std::vector<std::string> charted;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (sizes[i] > least) charted.push_back(names[i]);
  charted.emplace_back("other");
  return charted;
}

std::string stage_chart(const LogFile& log, const std::vector<std::string>& stages, double worst_ms) {
  const Rows rows = rows_of(log);
  const auto stacks = stacks_of(log, rows, stages);
  const Axes axes = axes_of(std::span(&rows, 1), worst_ms);
  std::string text = open_svg("Milliseconds of the stages of frames over the animation") + axes.svg();
  for (std::size_t stage = 0; stage < stages.size(); ++stage)
    text += fmt::format("<path class=\"stage{}\" d=\"{}\"/>\n",
                        stage + 1 == stages.size() ? most_stages : stage, area_of(axes, rows, stacks, stage));
  for (std::size_t i = 0; i < rows.frames.size() && rows.frames.size() <= most_tips; ++i) {
    std::string said = fmt::format("frame {}: {:.2f} ms", rows.frames[i]->frame, stacks[i].back());
    for (std::size_t stage = stages.size(); stage-- > 0;)
      said += fmt::format("\n{}: {:.2f}", stages[stage],
                          stacks[i][stage] - (stage == 0 ? 0.0 : stacks[i][stage - 1]));
    text += tip(axes, rows, i, said);
  }
  return text + "</svg>\n";
}

}  // namespace tenebra::viewer
