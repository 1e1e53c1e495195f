#include "io/output_stream.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/fail.h"

namespace tenebra::io {
namespace {

/// Standard output or error, if `found` is where that goes.
Descriptor standard_stream(const struct stat& found) {
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open {};
    if (::fstat(stream, &open) == 0 && open.st_dev == found.st_dev && open.st_ino == found.st_ino)
      return Descriptor(::fcntl(stream, F_DUPFD_CLOEXEC, 0));
  }
  return {};
}

const char* kind_of(mode_t mode) {
  if (S_ISFIFO(mode)) return "a named pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISBLK(mode) ? "a disk" : "something unknown";
}

}  // namespace

Expected<Descriptor> open_stream(const std::filesystem::path& path, const struct stat& found) {
  const auto failure = [&](int error) {
    return base::fail(ErrorKind::file, "cannot write {}: {}", path.string(),
                      std::generic_category().message(error));
  };
  if (S_ISDIR(found.st_mode)) return failure(EISDIR);
  if (Descriptor stream = standard_stream(found)) return stream;
  if (S_ISREG(found.st_mode)) return Descriptor();
  if (!S_ISCHR(found.st_mode))
    return base::fail(ErrorKind::file, "cannot write {}: found {}, expected a file, /dev/null or /dev/stdout",
                      path.string(), kind_of(found.st_mode));
  Descriptor device(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!device) return failure(errno);
  ::fcntl(device.number(), F_SETFL, 0);  // from here on it may take its time
  return device;
}

}  // namespace tenebra::io
