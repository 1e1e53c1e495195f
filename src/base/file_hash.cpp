#include "base/file_hash.h"

#define XXH_INLINE_ALL
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <system_error>
#include <vector>

#include "base/descriptor.h"
#include "base/fail.h"

namespace tenebra::base {
namespace {

std::string hexadecimal(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string text_hash(std::string_view text) {
  return hexadecimal(XXH3_128bits(text.data(), text.size()));
}

Expected<std::string> file_hash(const std::filesystem::path& path) {
  const auto failure = [&] { return fail("{}: {}", path.string(), std::generic_category().message(errno)); };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));  // a pipe is not waited for
  struct stat found {};
  if (!file || ::fstat(file.number(), &found) != 0) return failure();
  if (!S_ISREG(found.st_mode))
    return fail("{}: found something that is no file, expected one", path.string());
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  std::vector<char> part(std::size_t{1} << 20);
  for (;;) {
    const ssize_t count = ::read(file.number(), part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failure();
    if (count == 0) return hexadecimal(XXH3_128bits_digest(&state));
    XXH3_128bits_update(&state, part.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace tenebra::base
