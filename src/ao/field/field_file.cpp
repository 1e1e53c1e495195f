#include "ao/field/field_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <system_error>
#include <type_traits>

#include "ao/field/field_chords.h"
#include "base/fail.h"
#include "base/output_file.h"

namespace tenebra::ao {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "fields are stored as they lie in memory");

/// Counts up whenever the same geometry and settings give another table, or the file another form.
constexpr std::uint32_t version = 1;
constexpr std::array<char, 8> magic{'t', 'e', 'n', 'e', 'f', 'l', 'd', '\n'};
constexpr int compression_level = 3;

/// Stands in front of the compressed bytes.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t bits;
  FieldKey key;
  double bound[6];             ///< centre, axes
  std::uint64_t plain_bytes;   ///< of the three parts below
  std::uint64_t packed_bytes;  ///< what follows the header
  FieldKey checksum;           ///< of the header with this zero, and of all that follows
};
static_assert(sizeof(Header) == 112);

FieldKey digest(XXH3_state_t& state) {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return {hash.low64, hash.high64};
}

FieldKey checksum(Header header, std::string_view packed) {
  header.checksum = {};
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, &header, sizeof header);
  XXH3_128bits_update(&state, packed.data(), packed.size());
  return digest(state);
}

/// What is stored of a field, one part after the other.
template <class Field>
auto parts(Field& field) {
  const auto bytes = [](auto& vector, std::size_t size) {
    auto whole = [&] {
      if constexpr (std::is_const_v<Field>)
        return std::as_bytes(std::span(vector));
      else
        return std::as_writable_bytes(std::span(vector));
    }();
    return whole.first(size);
  };
  return std::array{bytes(field.mean, field.mean.size() * sizeof(float)),
                    bytes(field.close, field.close.size() * sizeof(std::uint32_t)),
                    bytes(field.table, field.shape.bytes)};
}

std::size_t plain_size(const DisplacementField& field) {
  std::size_t size = 0;
  for (const auto& part : parts(field)) size += part.size();
  return size;
}

Expected<std::string> read_whole(const fs::path& path, std::size_t most) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return base::fail("{}: {}", path.string(), error.message());
  if (size > most) return base::fail("{}: found {} bytes, expected at most {}", path.string(), size, most);
  std::string bytes(size, '\0');
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    return base::fail("{}: cannot be read", path.string());
  return bytes;
}

}  // namespace

FieldKey field_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   const FieldSettings& settings) {
  const std::uint64_t sizes[] = {version,
                                 static_cast<std::uint64_t>(settings.layout),
                                 static_cast<std::uint64_t>(settings.positions),
                                 static_cast<std::uint64_t>(settings.directions),
                                 static_cast<std::uint64_t>(settings.bits),
                                 positions.size(),
                                 triangles.size()};
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, sizes, sizeof sizes);
  XXH3_128bits_update(&state, positions.data(), positions.size_bytes());
  XXH3_128bits_update(&state, triangles.data(), triangles.size_bytes());
  return digest(state);
}

fs::path field_path(const fs::path& folder, const FieldKey& key) {
  return folder / fmt::format("{:016x}{:016x}.field", key.high, key.low);
}

Expected<void> save_field(const fs::path& folder, const FieldKey& key, const DisplacementField& field) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return base::fail("{}: {}", folder.string(), error.message());
  std::string plain;
  plain.reserve(plain_size(field));
  for (const auto& part : parts(field)) plain.append(reinterpret_cast<const char*>(part.data()), part.size());
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), compression_level);
  if (ZSTD_isError(size))
    return base::fail("{}: {}", field_path(folder, key).string(), ZSTD_getErrorName(size));
  packed.resize(size);
  const auto& [centre, axes] = field.bound;
  Header header{magic,
                version,
                static_cast<std::uint32_t>(field.bits),
                key,
                {centre.x, centre.y, centre.z, axes.x, axes.y, axes.z},
                plain.size(),
                packed.size(),
                {}};
  header.checksum = checksum(header, packed);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  return base::write_file(field_path(folder, key), bytes + packed);
}

Expected<DisplacementField> load_field(const fs::path& folder, const FieldKey& key,
                                       const FieldSettings& settings) {
  const Expected<FieldShape> shape = field_shape(settings);
  if (!shape) return tl::unexpected(shape.error());
  const fs::path path = field_path(folder, key);
  DisplacementField field = empty_field(settings, *shape);
  const std::size_t plain_bytes = plain_size(field);
  const Expected<std::string> bytes = read_whole(path, sizeof(Header) + ZSTD_compressBound(plain_bytes));
  if (!bytes) return tl::unexpected(bytes.error());
  Header header{};
  if (bytes->size() < sizeof header)
    return base::fail("{}: found {} bytes, expected a field's header", path.string(), bytes->size());
  std::memcpy(&header, bytes->data(), sizeof header);
  const std::string_view packed = std::string_view(*bytes).substr(sizeof header);
  if (header.magic != magic || header.version != version)
    return base::fail("{}: found another kind or version of file, expected a field of version {}",
                      path.string(), version);
  if (header.packed_bytes != packed.size() || header.checksum != checksum(header, packed))
    return base::fail("{}: found damaged bytes, expected those that were written", path.string());
  if (header.key != key || header.plain_bytes != plain_bytes ||
      header.bits != static_cast<std::uint32_t>(settings.bits))
    return base::fail("{}: found a field of other geometry or settings, expected the key in its name",
                      path.string());
  std::string plain(plain_bytes, '\0');
  if (ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size()) != plain_bytes)
    return base::fail("{}: found bytes that do not unpack, expected {} bytes", path.string(), plain_bytes);
  const char* from = plain.data();
  for (const auto& part : parts(field)) {
    std::copy(from, from + part.size(), reinterpret_cast<char*>(part.data()));
    from += part.size();
  }
  const double(&b)[6] = header.bound;
  field.bound = {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
  return field;
}

}  // namespace tenebra::ao
