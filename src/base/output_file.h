// Output files that are whole or absent.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "base/expected.h"

namespace tenebra {

/// Writes `bytes` to `path`: into a temporary file beside it, flushed to disk, then renamed over it. On any
/// failure (no such folder, no space, no permission, `path` is a folder) the temporary file is removed, an
/// earlier file at `path` is untouched, and the sentence names the path and the system's reason.
/// A `path` that is a device or pipe (/dev/full, /dev/stdout) is written directly.
Expected<void> write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace tenebra
