// Input files, read whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <tenebra/expected.h>
#include "io/descriptor.h"

namespace tenebra::io {

/// A regular file, open to be read, and its size in bytes.
struct InputFile {
  Descriptor file;
  std::size_t size = 0;

  /// The next bytes, `most` at most; their number, 0: the end. Fails without a path in the sentence.
  Expected<std::size_t> read(char* to, std::size_t most) const;
};
/// Opens one. Anything else (a folder, a pipe, a device) is refused and never waited for. Failures are
/// sentences that begin with the path.
Expected<InputFile> open_input_file(const std::filesystem::path& path);

/// The bytes of a regular file, `most` at most; refuses and fails as open_input_file().
Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most);

}  // namespace tenebra::io
