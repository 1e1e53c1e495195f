// The frame log: a CSV file with one row per frame, and comment lines above that say what was measured where.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <tenebra/expected.h>
#include "base/output_file.h"
#include "render/log/frame_columns.h"

namespace tenebra::render {

/// One thing the reader of a log must know to repeat the run: "threads", "2".
struct LogSetting {
  std::string name;
  std::string value;
};

/// Rows are written as they come, to a temporary file beside `path`; `finish` makes the log appear. A log
/// that is dropped before leaves nothing (see OutputFile).
class FrameLog {
public:
  /// Writes the comment lines "# name: value" and the header line.
  static Expected<FrameLog> create(const std::filesystem::path& path, std::span<const LogSetting> settings);

  Expected<void> add(const FrameRecord& record);
  /// A comment line "# name: value" between the rows: what came up with the next frame.
  Expected<void> comment(const LogSetting& setting);
  Expected<void> finish();

private:
  explicit FrameLog(base::OutputFile file) : file_(std::move(file)) {}
  base::OutputFile file_;
};

/// The header line: frame,time_s,raster_ms,... without a line break.
std::string frame_log_header();
/// One row without a line break. Times have microseconds; a time of the clip has nine digits.
std::string frame_log_row(const FrameRecord& record);

}  // namespace tenebra::render
