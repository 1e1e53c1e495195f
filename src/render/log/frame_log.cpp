#include "render/log/frame_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "render/log/stage_sets.h"

namespace tenebra::render {
namespace {

std::string comment_line(const LogSetting& setting) {
  return fmt::format("# {}: {}\n", on_one_line(setting.name), on_one_line(setting.value));
}

constexpr std::string_view from_here_on = "# from here on ";

/// Gives the setting of that name another value.
void change(std::vector<LogSetting>& settings, std::string_view name, std::string_view value) {
  std::erase_if(settings, [&](const LogSetting& setting) { return setting.name == name; });
  settings.push_back({std::string(name), std::string(value)});
}

}  // namespace

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

std::string frame_log_header() {
  std::string line = "frame,time_s";
  for (const auto& column : leading_timings) line.append(",").append(column.name);
  for (const auto& column : count_columns) line.append(",").append(column.name);
  for (const auto& column : closing_timings) line.append(",").append(column.name);
  for (const auto& column : method_columns) line.append(",").append(column.name);
  for (const auto& column : estimate_columns) line.append(",").append(column.name);
  for (const auto& column : list_columns) line.append(",").append(column);
  return line;
}

std::string frame_log_row(const FrameRecord& record) {
  std::string line = fmt::format("{},{:.9g}", record.frame, record.time_s);
  for (const auto& column : leading_timings) line += fmt::format(",{:.3f}", record.timings.*column.value);
  for (const auto& column : count_columns) line += fmt::format(",{}", column.value(record));
  for (const auto& column : closing_timings) line += fmt::format(",{:.3f}", record.timings.*column.value);
  for (const auto& column : method_columns) line += fmt::format(",{}", column.value(record));
  for (const auto& column : estimate_columns) line += fmt::format(",{:.3f}", column.value(record));
  const StageSet ran = stages_run(record.timings);
  return line.append(",").append(stage_names(record.asked & ~ran)).append(",").append(stage_names(ran));
}

LogPast parse_log(std::string_view text, std::string_view header) {
  LogPast past;
  for (std::size_t end = 0; (end = text.find('\n', past.whole_bytes)) != std::string_view::npos;) {
    const std::string_view line = text.substr(past.whole_bytes, end - past.whole_bytes);
    past.whole_bytes = end + 1;
    const std::size_t colon = line.find(": ");
    int frame = 0;
    if (past.has_header && line.starts_with(from_here_on) && colon != std::string_view::npos) {
      change(past.now, line.substr(from_here_on.size(), colon - from_here_on.size()), line.substr(colon + 2));
    } else if (past.has_header) {
      const auto read = std::from_chars(line.data(), line.data() + line.size(), frame);
      const bool is_field = read.ptr == line.data() + line.size() || *read.ptr == ',';
      if (read.ec == std::errc() && is_field) past.frames.push_back(frame);
    } else if (line == header) {
      past.has_header = true;
    } else if (line.starts_with("# ") && colon != std::string_view::npos) {
      past.settings.push_back({std::string(line.substr(2, colon - 2)), std::string(line.substr(colon + 2))});
      past.now.push_back(past.settings.back());
    }
  }
  return past;
}

std::string log_head(std::span<const LogSetting> settings, std::string_view header) {
  std::string head;
  for (const LogSetting& setting : settings) head += comment_line(setting);
  return head.append(header).append("\n");
}

Expected<FrameLog> FrameLog::open(const std::filesystem::path& path) {
  auto file = io::Journal::open(path);
  if (!file) return tl::unexpected(file.error());
  return FrameLog(std::move(*file));
}

Expected<FrameLog> FrameLog::create(const std::filesystem::path& path, std::span<const LogSetting> settings) {
  auto log = open(path);
  if (!log) return log;
  if (auto begun = log->begin(settings); !begun) return tl::unexpected(begun.error());
  return log;
}

Expected<LogPast> FrameLog::past() const {
  const auto text = file_.read();
  if (!text) return tl::unexpected(text.error());
  return parse_log(*text, frame_log_header());
}

Expected<void> FrameLog::begin(std::span<const LogSetting> settings) {
  return file_.begin(log_head(settings, frame_log_header()));
}

Expected<void> FrameLog::add(const FrameRecord& record) {
  return file_.append(frame_log_row(record) + "\n");
}

Expected<void> FrameLog::comment(const LogSetting& setting) {
  return file_.append(comment_line(setting));
}

Expected<void> FrameLog::finish() {
  return file_.finish();
}

}  // namespace tenebra::render
