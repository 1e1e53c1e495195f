// Logs of one render that ran in parts, as one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "log/log_file.h"

namespace tenebra::viewer {

struct MergedLog {
  std::string text;  ///< of the whole file
  std::size_t frames = 0;
  std::vector<std::string> remarks;  ///< sentences that a user should see: frames that were drawn twice
};

/// Rows in the order of their frames. A frame that was drawn more than once counts as the log given last has
/// it, and of one log the last row. Fails with a sentence that names the difference if the logs are not of
/// one render: other columns or settings, or other counts for the same frame. Where it ran (machine, threads,
/// vector instructions, cache) may differ, and is listed. `logs`: at least one.
Expected<MergedLog> merge_logs(std::span<const LogFile> logs);

}  // namespace tenebra::viewer
