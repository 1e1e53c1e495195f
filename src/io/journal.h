// Files that grow by whole lines while something long runs, and can be continued after it was killed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tenebra/expected.h>
#include "io/descriptor.h"

namespace tenebra::io {

/// A text file under its own name from the first line on. Each addition is written at once and is there whole
/// or, on a full disk, not at all; what was there before stays. SIGKILL can cut an addition short:
/// whoever reads or continues the file leaves out a last line without its end. What open_stream opens
/// (/dev/stdout, /dev/null) is written as it comes. One process at a time writes a journal, or any number do
/// whose lines have one length: a lock says so, which ends with its holder. Failures are sentences with the
/// path.
class Journal {
public:
  enum class Writers { one, many };

  /// Opens `path`, as it is, or makes it. Fails where another process writes it that wants to be alone
  /// (`many`: for two seconds, so that it can begin), and for what open_stream refuses.
  static Expected<Journal> open(const std::filesystem::path& path, Writers writers = Writers::one);

  /// Whether no other process can write it now.
  bool is_alone() const { return is_alone_; }
  /// Lets others write, too. False if one came in between that wants to be alone.
  bool share();

  /// False for a stream or device, which has no past.
  bool is_file() const { return is_file_; }
  /// What is there.
  Expected<std::string> read() const;
  /// Empties it and writes the first lines. A file that was made for it is removed if that fails.
  Expected<void> begin(std::string_view head);
  /// Cuts off all but the first `bytes`: a torn last line.
  Expected<void> keep(std::size_t bytes);
  Expected<void> append(std::string_view lines);
  /// Flushes to disk and closes. Call it once, last.
  Expected<void> finish();

private:
  Journal() = default;
  tl::unexpected<Error> system_failure(int error) const;
  bool take_lock(Writers writers);
  Expected<void> write(std::string_view bytes);

  Descriptor file_;
  std::filesystem::path path_;
  bool is_file_ = false;
  bool is_new_ = false;
  bool is_alone_ = true;
  std::size_t size_ = 0;  ///< of the file, whole lines
};

}  // namespace tenebra::io
