// A log in a few numbers.
#pragma once

#include <string>
#include <vector>

#include "base/statistics.h"
#include "log/log_file.h"

namespace tenebra::viewer {

/// One column over the frames that count.
struct ColumnSummary {
  std::string name;
  base::Summary values;
  int worst_frame = 0;
  double mean = 0;
  bool has_history = false;  ///< a count that also depends on the frames before, not on the frame alone
};

/// First frames of chunks build what later ones keep, so they stand apart: percentiles are of the others.
/// If there are no others (a process for each frame) they count.
struct LogSummary {
  std::string log;
  std::vector<render::LogSetting> settings;
  std::size_t frames = 0;
  std::vector<int> first_frames;      ///< numbers of the frames that open a chunk, in the order of the log
  bool counts_first_frames = false;   ///< there are no others
  std::vector<ColumnSummary> times;   ///< milliseconds; stages in the order in which a frame runs them, then
                                      ///< the whole frame; without stages that took no time
  std::vector<ColumnSummary> counts;  ///< the other columns, without those that are 0 throughout
  base::Summary first_total_ms;       ///< the whole frame, of first frames
  std::vector<std::string> remarks;   ///< of the log
};

/// Fails if the log has no frames.
Expected<LogSummary> summarize_log(const LogFile& log);

/// Columns of stage times ("raster_ms"), in the order in which a frame runs them; the columns that only
/// sum up others are left out.
std::vector<std::size_t> stage_columns(const LogFile& log);

std::string summary_text(const LogSummary& summary);
std::string summary_json(const LogSummary& summary);

}  // namespace tenebra::viewer
