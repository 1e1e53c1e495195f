#include "render/log/frame_log.h"

#include <fmt/core.h>

#include <algorithm>

namespace tenebra::render {
namespace {

/// Comments are one line each, whatever a file name holds.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

std::string comment_line(const LogSetting& setting) {
  return fmt::format("# {}: {}\n", on_one_line(setting.name), on_one_line(setting.value));
}

}  // namespace

std::string frame_log_header() {
  std::string line = "frame,time_s";
  for (const auto& column : leading_timings) line.append(",").append(column.name);
  for (const auto& column : count_columns) line.append(",").append(column.name);
  for (const auto& column : closing_timings) line.append(",").append(column.name);
  for (const auto& column : method_columns) line.append(",").append(column.name);
  for (const auto& column : estimate_columns) line.append(",").append(column.name);
  return line;
}

std::string frame_log_row(const FrameRecord& record) {
  std::string line = fmt::format("{},{:.9g}", record.frame, record.time_s);
  for (const auto& column : leading_timings) line += fmt::format(",{:.3f}", record.timings.*column.value);
  for (const auto& column : count_columns) line += fmt::format(",{}", column.value(record));
  for (const auto& column : closing_timings) line += fmt::format(",{:.3f}", record.timings.*column.value);
  for (const auto& column : method_columns) line += fmt::format(",{}", column.value(record));
  for (const auto& column : estimate_columns) line += fmt::format(",{:.3f}", column.value(record));
  return line;
}

Expected<FrameLog> FrameLog::create(const std::filesystem::path& path, std::span<const LogSetting> settings) {
  auto file = base::OutputFile::create(path);
  if (!file) return tl::unexpected(file.error());
  std::string head;
  for (const LogSetting& setting : settings) head += comment_line(setting);
  head += frame_log_header() + "\n";
  if (auto written = file->write(head); !written) return tl::unexpected(written.error());
  return FrameLog(std::move(*file));
}

Expected<void> FrameLog::add(const FrameRecord& record) {
  return file_.write(frame_log_row(record) + "\n");
}

Expected<void> FrameLog::comment(const LogSetting& setting) {
  return file_.write(comment_line(setting));
}

Expected<void> FrameLog::finish() {
  return file_.commit();
}

}  // namespace tenebra::render
