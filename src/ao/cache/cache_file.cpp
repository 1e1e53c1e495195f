#include "ao/cache/cache_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <system_error>

#include "base/fail.h"
#include "io/input_file.h"
#include "io/output_file.h"

namespace tenebra::ao {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

constexpr int compression_level = 3;

/// Stands in front of the compressed bytes.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t unused;  ///< 0
  CacheKey key;
  std::uint64_t plain_bytes;
  std::uint64_t packed_bytes;  ///< what follows the header
  CacheKey checksum;           ///< of the header with this zero, and of all that follows
};
static_assert(sizeof(Header) == 64);

CacheKey digest(XXH3_state_t& state) {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return {hash.low64, hash.high64};
}

CacheKey checksum(Header header, std::string_view packed) {
  header.checksum = {};
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, &header, sizeof header);
  XXH3_128bits_update(&state, packed.data(), packed.size());
  return digest(state);
}

}  // namespace

CacheKey cache_key(std::initializer_list<std::span<const std::byte>> parts) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  for (const auto& part : parts) {
    const std::uint64_t size = part.size();
    XXH3_128bits_update(&state, &size, sizeof size);
    XXH3_128bits_update(&state, part.data(), part.size());
  }
  return digest(state);
}

fs::path cache_path(const fs::path& folder, const CacheKind& kind, const CacheKey& key) {
  return folder / fmt::format("{:016x}{:016x}.{}", key.high, key.low, kind.name);
}

bool cache_file_exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

Expected<void> save_cache_file(const fs::path& folder, const CacheKind& kind, const CacheKey& key,
                               std::string_view bytes) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return base::fail("{}: {}", folder.string(), error.message());
  const fs::path path = cache_path(folder, kind, key);
  const fs::file_status found = fs::status(path, error);
  if (fs::exists(found) && !fs::is_regular_file(found))
    return base::fail("{}: found something that is no file, expected one or none", path.string());
  std::string file(sizeof(Header) + ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(file.data() + sizeof(Header), file.size() - sizeof(Header),
                                         bytes.data(), bytes.size(), compression_level);
  if (ZSTD_isError(size)) return base::fail("{}: {}", path.string(), ZSTD_getErrorName(size));
  file.resize(sizeof(Header) + size);
  Header header{kind.magic, kind.version, 0, key, bytes.size(), size, {}};
  header.checksum = checksum(header, std::string_view(file).substr(sizeof header));
  std::memcpy(file.data(), &header, sizeof header);
  return io::write_file(path, file);
}

Expected<CacheReader> CacheReader::open(const fs::path& folder, const CacheKind& kind, const CacheKey& key,
                                        std::size_t least, std::size_t most) {
  CacheReader reader;
  reader.path_ = cache_path(folder, kind, key);
  const std::string path = reader.path_.string();
  Expected<std::string> bytes = io::read_file(reader.path_, sizeof(Header) + ZSTD_compressBound(most));
  if (!bytes) return tl::unexpected(bytes.error());
  Header header{};
  if (bytes->size() < sizeof header)
    return base::fail("{}: found {} bytes, expected a header", path, bytes->size());
  std::memcpy(&header, bytes->data(), sizeof header);
  const std::string_view packed = std::string_view(*bytes).substr(sizeof header);
  if (header.magic != kind.magic || header.version != kind.version)
    return base::fail("{}: found another kind or version of file, expected {} of version {}", path, kind.name,
                      kind.version);
  if (header.packed_bytes != packed.size() || header.checksum != checksum(header, packed))
    return base::fail("{}: found damaged bytes, expected those that were written", path);
  if (header.key != key || header.plain_bytes < least || header.plain_bytes > most)
    return base::fail("{}: found {} of other geometry or settings, expected the key in its name", path,
                      kind.name);
  reader.plain_bytes_ = header.plain_bytes;
  reader.file_ = std::move(*bytes);
  return reader;
}

Expected<void> CacheReader::read(std::span<const std::span<std::byte>> parts) const {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (stream == nullptr) throw std::bad_alloc();
  ZSTD_inBuffer in{file_.data() + sizeof(Header), file_.size() - sizeof(Header), 0};
  for (const std::span<std::byte>& part : parts) {
    ZSTD_outBuffer out{part.data(), part.size(), 0};
    while (out.pos < out.size) {
      const std::size_t before = out.pos;
      const std::size_t left = ZSTD_decompressStream(stream.get(), &out, &in);
      if (ZSTD_isError(left) || (out.pos == before && in.pos == in.size))
        return base::fail("{}: found bytes that do not unpack, expected {} bytes", path_.string(),
                          plain_bytes_);
    }
  }
  return {};
}

}  // namespace tenebra::ao
