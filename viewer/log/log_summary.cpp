#include "log/log_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/fail.h"

namespace tenebra::viewer {
namespace {

/// Counts that follow from what frames before left in memory or on disk too: clusters of triangles, which are
/// kept while they fit, fields and samples. All others are those of the frame alone; none depends on threads.
constexpr std::array<std::string_view, 14> counts_with_history{
    "nodes",        "leaf_tests",           "early_accepts", "float_unknown",   "double_unknown",
    "tree_bytes",   "degenerate_triangles", "ao_lookups",    "ao_fields_built", "ao_field_bytes",
    "ao_rays_cast", "ao_sample_bytes",      "ao_peak_bytes", "ao_cache_cells"};

bool is_time(std::string_view column) {
  return column.ends_with("_ms");
}

ColumnSummary summarize_column(const LogFile& log, std::size_t column, bool of_first_frames) {
  std::vector<double> values;
  std::vector<int> numbers;
  for (const LoggedFrame& frame : log.frames) {
    if (frame.opens_chunk != of_first_frames) continue;
    values.push_back(frame.values[column]);
    numbers.push_back(frame.frame);
  }
  ColumnSummary summary;
  summary.name = log.columns[column];
  summary.has_history = std::find(counts_with_history.begin(), counts_with_history.end(), summary.name) !=
                        counts_with_history.end();
  summary.values = base::summarize(values);
  if (values.empty()) return summary;
  summary.worst_frame = numbers[summary.values.worst_at];
  summary.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return summary;
}

nlohmann::ordered_json json_of(const ColumnSummary& column) {
  return {{"median", column.values.median},
          {"mean", column.mean},
          {"percentile_95", column.values.percentile_95},
          {"percentile_99", column.values.percentile_99},
          {"worst", column.values.worst},
          {"worst_frame", column.worst_frame}};
}

std::string list_of(const std::vector<int>& frames) {
  constexpr std::size_t most = 12;
  const auto end = frames.begin() + static_cast<std::ptrdiff_t>(std::min(frames.size(), most));
  return fmt::format("{}{}", fmt::join(frames.begin(), end, ", "), frames.size() > most ? ", ..." : "");
}

std::string text_row(const ColumnSummary& column, std::string_view name, int decimals) {
  return fmt::format("{:<24}{:>14.{}f}{:>14.{}f}{:>14.{}f}{:>14.{}f}   {}{}\n", name, column.values.median,
                     decimals, column.values.percentile_95, decimals, column.values.percentile_99, decimals,
                     column.values.worst, decimals, column.worst_frame, column.has_history ? " *" : "");
}

std::string heading(std::string_view what) {
  return fmt::format("{:<24}{:>14}{:>14}{:>14}{:>14}   frame\n", what, "median", "95 %", "99 %", "worst");
}

}  // namespace

std::vector<std::size_t> stage_columns(const LogFile& log) {
  std::vector<std::size_t> columns;
  for (const auto& stage : render::frame_stages)
    if (const auto column = log.column(std::string(stage.name) + "_ms")) columns.push_back(*column);
  for (std::size_t i = 0; i < log.columns.size(); ++i) {
    const bool is_known = std::find(columns.begin(), columns.end(), i) != columns.end();
    if (is_time(log.columns[i]) && log.columns[i] != "total_ms" && !is_known) columns.push_back(i);
  }
  return columns;
}

Expected<LogSummary> summarize_log(const LogFile& log) {
  if (log.frames.empty()) return base::fail("{}: found no frames, expected at least one row", log.name);
  LogSummary summary;
  summary.log = log.name;
  summary.settings = log.settings;
  summary.frames = log.frames.size();
  summary.remarks = log.remarks;
  for (const LoggedFrame& frame : log.frames)
    if (frame.opens_chunk) summary.first_frames.push_back(frame.frame);
  summary.counts_first_frames = summary.first_frames.size() == summary.frames;
  const auto column_of = [&](std::size_t column) {
    return summarize_column(log, column, summary.counts_first_frames);
  };
  std::vector<std::size_t> times = stage_columns(log);
  times.push_back(*log.column("total_ms"));
  for (const std::size_t column : times)
    if (auto of_column = column_of(column); of_column.values.worst > 0)
      summary.times.push_back(std::move(of_column));
  for (std::size_t i = 0; i < log.columns.size(); ++i) {
    if (is_time(log.columns[i]) || log.columns[i] == "frame" || log.columns[i] == "time_s") continue;
    if (auto of_column = column_of(i); of_column.values.worst > 0)
      summary.counts.push_back(std::move(of_column));
  }
  summary.first_total_ms = summarize_column(log, *log.column("total_ms"), true).values;
  return summary;
}

std::string summary_text(const LogSummary& summary) {
  std::string text = heading("milliseconds");
  for (const ColumnSummary& column : summary.times) {
    const std::string_view name = column.name;
    text += text_row(column, name.substr(0, name.size() - 3), 2);
  }
  text += "\n" + heading("counts");
  for (const ColumnSummary& column : summary.counts) text += text_row(column, column.name, 0);
  const bool has_history = std::any_of(summary.counts.begin(), summary.counts.end(),
                                       [](const ColumnSummary& column) { return column.has_history; });
  if (has_history) text += "* also depends on the frames before\n";
  text += fmt::format("\n{}: {} frames", summary.log, summary.frames);
  if (summary.counts_first_frames)
    return text + ", each the first of its process or chunk, and counted because there are no others\n";
  return text +
         fmt::format(". Not counted above: {} first of a chunk ({}), median {:.2f} ms, worst {:.2f} ms\n",
                     summary.first_frames.size(), list_of(summary.first_frames),
                     summary.first_total_ms.median, summary.first_total_ms.worst);
}

std::string summary_json(const LogSummary& summary) {
  using Json = nlohmann::ordered_json;
  Json json{{"log", summary.log}, {"frames", summary.frames}};
  json["settings"] = Json::array();
  for (const render::LogSetting& setting : summary.settings)
    json["settings"].push_back({{"name", setting.name}, {"value", setting.value}});
  json["first_frames"] = {{"frames", summary.first_frames},
                          {"counted", summary.counts_first_frames},
                          {"total_ms_median", summary.first_total_ms.median},
                          {"total_ms_worst", summary.first_total_ms.worst}};
  json["times_ms"] = Json::object();
  for (const ColumnSummary& column : summary.times)
    json["times_ms"][column.name.substr(0, column.name.size() - 3)] = json_of(column);
  json["counts"] = Json::object();
  for (const ColumnSummary& column : summary.counts) {
    json["counts"][column.name] = json_of(column);
    json["counts"][column.name]["has_history"] = column.has_history;
  }
  json["remarks"] = summary.remarks;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tenebra::viewer
