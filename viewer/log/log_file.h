// A frame log (`render --log`) as it is read back: settings, columns, rows, and which frames open a chunk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>
#include "render/log/frame_log.h"

namespace tenebra::viewer {

/// The name of the comment line that stands before the first frame of a chunk in a merged log.
inline constexpr std::string_view chunk_comment = "chunk";
/// The name of a comment line that says which log a merged one was made of.
inline constexpr std::string_view merged_comment = "merged";

/// One row of a log.
struct LoggedFrame {
  int frame = 0;
  bool opens_chunk = false;               ///< the first that a process drew: it builds what later ones keep
  std::string row;                        ///< as it stands in the file, without the line break
  std::vector<double> values;             ///< by LogFile::columns; of lists of stages 0
  std::vector<render::LogSetting> notes;  ///< comment lines just above the row
};

struct LogFile {
  std::string name;  ///< the path as the user gave it
  std::vector<render::LogSetting> settings;
  std::vector<std::string> columns;
  std::vector<LoggedFrame> frames;   ///< in the order of the file
  std::vector<std::string> remarks;  ///< sentences that a user should see: a last row that is cut off

  /// Index of a column; none: the log does not have it.
  std::optional<std::size_t> column(std::string_view name) const;
  /// Value of the first setting of that name, or "".
  std::string setting(std::string_view name) const;
};

/// Reads a log. A file that ends in the middle of a row (a killed render) counts up to its last whole row.
/// Fails with the file and the line on what is no row of a frame log. A chunk begins with the first row,
/// where the frames' numbers jump, and where the header line or a comment "# chunk: ...", "# resumed: ..." or
/// "# from here on ..." stands between rows; in a merged log only where it says so.
Expected<LogFile> read_log(const std::filesystem::path& path);

/// A log from the text of a file. `name`: for messages.
Expected<LogFile> parse_log(const std::string& name, std::string_view text);

/// Keeps only the last of several rows of one frame, whose files were gone and drawn again. With a remark.
void keep_last_rows(LogFile& log);

}  // namespace tenebra::viewer
