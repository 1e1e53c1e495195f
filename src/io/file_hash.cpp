#include "io/file_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <vector>

#include "base/fail.h"
#include "io/input_file.h"

namespace tenebra::io {
namespace {

std::string hexadecimal(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string text_hash(std::string_view text) {
  return hexadecimal(XXH3_128bits(text.data(), text.size()));
}

Expected<std::string> file_hash(const std::filesystem::path& path) {
  const auto file = open_input_file(path);
  if (!file) return tl::unexpected(file.error());
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  std::vector<char> part(std::size_t{1} << 20);
  for (;;) {
    const auto count = file->read(part.data(), part.size());
    if (!count) return base::fail(ErrorKind::file, "{}: {}", path.string(), count.error().message);
    if (*count == 0) return hexadecimal(XXH3_128bits_digest(&state));
    XXH3_128bits_update(&state, part.data(), *count);
  }
}

}  // namespace tenebra::io
