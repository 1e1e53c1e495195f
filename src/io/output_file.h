// Output files that are whole or absent: written beside their final name, flushed, then renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::io {

/// A file being written. Bytes go to a temporary file in the folder of `path`; `commit` makes them appear
/// under `path`, replacing an earlier file in one step. Without a successful commit the temporary file is
/// removed and an earlier file at `path` is untouched. What open_stream opens (/dev/null, /dev/stdout) is
/// written directly. Symbolic links are followed. Every failure is a sentence with the path and the system's
/// reason.
class OutputFile {
public:
  /// Fails if the folder is missing or not writable, or if `path` is a folder, a named pipe, a disk, a
  /// read-only file or too long a name; waits for nothing.
  static Expected<OutputFile> create(const std::filesystem::path& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

  Expected<void> write(std::string_view bytes);
  /// Flushes to disk, closes and renames; also reports what only close finds out. Call it once, last.
  Expected<void> commit();

private:
  OutputFile() = default;
  Expected<void> open_temporary();
  tl::unexpected<Error> system_failure(int error) const;

  int descriptor_ = -1;
  std::filesystem::path path_;       // as the user named it, for messages
  std::filesystem::path target_;     // with symbolic links followed
  std::filesystem::path temporary_;  // empty: `target_` is written directly
};

/// Removes temporary files that killed processes of this machine left in `folder`, and those of other
/// machines that are older than an hour. What is being written has a lock and stays.
void remove_stale_temporaries(const std::filesystem::path& folder);

/// Writes `bytes` to `path` with the guarantees of OutputFile.
Expected<void> write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace tenebra::io
