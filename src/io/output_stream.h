// Output that is not a file: /dev/stdout, /dev/null.
#pragma once

#include <sys/stat.h>

#include <filesystem>

#include <tenebra/expected.h>
#include "io/descriptor.h"

namespace tenebra::io {

/// What stands at `path`, of which `found` is known, opened to be written as it comes, without waiting: what
/// is standard output or error already, whatever it is (/dev/stdout, also as a pipe), and devices that take
/// characters (/dev/null, a terminal). None for other regular files, which are to be replaced as a whole.
/// Folders, named pipes, sockets and disks are refused: to open a pipe may wait for ever, and a disk's
/// contents would be gone.
Expected<Descriptor> open_stream(const std::filesystem::path& path, const struct stat& found);

}  // namespace tenebra::io
