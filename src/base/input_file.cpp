#include "base/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/descriptor.h"
#include "base/fail.h"

namespace tenebra::base {

Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most) {
  const auto failure = [&] { return fail("{}: {}", path.string(), std::generic_category().message(errno)); };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));  // a pipe is not waited for
  struct stat found {};
  if (!file || ::fstat(file.number(), &found) != 0) return failure();
  if (!S_ISREG(found.st_mode))
    return fail("{}: found something that is no file, expected one", path.string());
  const auto size = static_cast<std::size_t>(found.st_size);
  if (size > most) return fail("{}: found {} bytes, expected at most {}", path.string(), size, most);
  std::string bytes(size, '\0');
  for (std::size_t at = 0; at < size;) {
    const ssize_t count = ::read(file.number(), bytes.data() + at, size - at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failure();
    if (count == 0) return fail("{}: found {} bytes, expected {}", path.string(), at, size);
    at += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace tenebra::base
