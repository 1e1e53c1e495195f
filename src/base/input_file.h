// Input files, read whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <tenebra/expected.h>

namespace tenebra::base {

/// The bytes of a regular file, `most` at most. Anything else (a folder, a pipe, a device) is refused and
/// never waited for. Failures are sentences that begin with the path.
Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most);

}  // namespace tenebra::base
