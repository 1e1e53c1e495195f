#include "io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/fail.h"

namespace tenebra::io {

Expected<std::size_t> InputFile::read(char* to, std::size_t most) const {
  for (;;) {
    const ssize_t count = ::read(file.number(), to, most);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) return base::fail(ErrorKind::file, "{}", std::generic_category().message(errno));
  }
}

Expected<InputFile> open_input_file(const std::filesystem::path& path) {
  InputFile out{
      Descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))};  // a pipe is not waited for
  struct stat found {};
  if (!out.file || ::fstat(out.file.number(), &found) != 0)
    return base::fail(ErrorKind::file, "{}: {}", path.string(), std::generic_category().message(errno));
  if (!S_ISREG(found.st_mode))
    return base::fail("{}: found something that is no file, expected one", path.string());
  out.size = static_cast<std::size_t>(found.st_size);
  return out;
}

Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most) {
  const auto file = open_input_file(path);
  if (!file) return tl::unexpected(file.error());
  if (file->size > most)
    return base::fail("{}: found {} bytes, expected at most {}", path.string(), file->size, most);
  std::string bytes(file->size, '\0');
  for (std::size_t at = 0; at < bytes.size();) {
    const auto count = file->read(bytes.data() + at, bytes.size() - at);
    if (!count) return base::fail(ErrorKind::file, "{}: {}", path.string(), count.error().message);
    if (*count == 0)
      return base::fail(ErrorKind::file, "{}: found {} bytes, expected {}", path.string(), at, bytes.size());
    at += *count;
  }
  return bytes;
}

}  // namespace tenebra::io
