// The frame log: a CSV file with one row per frame, and comment lines above that say what was measured where.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>
#include "io/journal.h"
#include "render/log/frame_columns.h"

namespace tenebra::render {

/// A setting that the reader of a log needs to repeat the run: "threads", "2".
struct LogSetting {
  std::string name;
  std::string value;
};

/// What a log, or another table of frames with such comments, holds already.
struct LogPast {
  std::vector<LogSetting> settings;  ///< above the header line
  std::vector<LogSetting> now;       ///< the same, with what "from here on" lines changed since
  bool has_header = false;
  std::vector<int> frames;      ///< of its whole rows
  std::size_t whole_bytes = 0;  ///< up to the end of the last whole line
};
LogPast parse_log(std::string_view text, std::string_view header);
/// Comments are one line each, whatever a file name holds: control characters become blanks.
std::string on_one_line(std::string text);
/// The lines above the rows.
std::string log_head(std::span<const LogSetting> settings, std::string_view header);

/// A journal: it has its final name from the start, its comments come first, and each row is there whole once
/// it is added, however the program ends. A row that SIGKILL cut short while it was added is no row.
class FrameLog {
public:
  /// Writes the comment lines "# name: value" and the header line, in the place of an earlier log.
  static Expected<FrameLog> create(const std::filesystem::path& path, std::span<const LogSetting> settings);
  /// The log as it is: look at its past, then begin it anew or continue it.
  static Expected<FrameLog> open(const std::filesystem::path& path);
  Expected<LogPast> past() const;
  Expected<void> begin(std::span<const LogSetting> settings);
  Expected<void> go_on(const LogPast& past) { return file_.keep(past.whole_bytes); }

  Expected<void> add(const FrameRecord& record);
  /// A comment line "# name: value" between the rows: what came up with the next frame.
  Expected<void> comment(const LogSetting& setting);
  Expected<void> finish();

private:
  explicit FrameLog(io::Journal file) : file_(std::move(file)) {}
  io::Journal file_;
};

/// The header line: frame,time_s,raster_ms,... without a line break.
std::string frame_log_header();
/// One row without a line break. Times have microseconds; a time of the clip has nine digits.
std::string frame_log_row(const FrameRecord& record);

}  // namespace tenebra::render
