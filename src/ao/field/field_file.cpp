#include "ao/field/field_file.h"

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>

#include "ao/field/field_chords.h"

namespace tenebra::ao {

namespace {

namespace fs = std::filesystem;

constexpr CacheKind kind{{'t', 'e', 'n', 'e', 'f', 'l', 'd', '\n'}, 2, "field"};

/// The stored parts of a field, one after the other.
template <class Field>
auto parts(Field& field) {
  const auto bytes = [](auto& list, std::size_t size) {
    auto whole = [&] {
      if constexpr (std::is_const_v<Field>)
        return std::as_bytes(std::span(list));
      else
        return std::as_writable_bytes(std::span(list));
    }();
    return whole.first(size);
  };
  static_assert(sizeof(Ellipsoid) == 6 * sizeof(double));
  auto bound = std::span(&field.bound, 1);
  return std::array{bytes(bound, sizeof(Ellipsoid)), bytes(field.mean, field.mean.size() * sizeof(float)),
                    bytes(field.close, field.close.size() * sizeof(std::uint32_t)),
                    bytes(field.table, field.shape.bytes)};
}

std::size_t stored_size(const DisplacementField& field) {
  std::size_t size = 0;
  for (const auto& part : parts(field)) size += part.size();
  return size;
}

}  // namespace

CacheKey field_key(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   const FieldSettings& settings) {
  const std::uint64_t numbers[] = {kind.version, static_cast<std::uint64_t>(settings.layout),
                                   static_cast<std::uint64_t>(settings.positions),
                                   static_cast<std::uint64_t>(settings.directions),
                                   static_cast<std::uint64_t>(settings.bits)};
  return cache_key({std::as_bytes(std::span(numbers)), std::as_bytes(positions), std::as_bytes(triangles)});
}

fs::path field_path(const fs::path& folder, const CacheKey& key) {
  return cache_path(folder, kind, key);
}

Expected<void> save_field(const fs::path& folder, const CacheKey& key, const DisplacementField& field) {
  std::string bytes;
  bytes.reserve(stored_size(field));
  for (const auto& part : parts(field)) bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
  return save_cache_file(folder, kind, key, bytes);
}

Expected<DisplacementField> load_field(const fs::path& folder, const CacheKey& key,
                                       const FieldSettings& settings) {
  const Expected<FieldShape> shape = field_shape(settings);
  if (!shape) return tl::unexpected(shape.error());
  DisplacementField field = empty_field(settings, *shape);
  const std::size_t size = stored_size(field);
  const auto file = CacheReader::open(folder, kind, key, size, size);
  if (!file) return tl::unexpected(file.error());
  if (auto done = file->read(parts(field)); !done) return tl::unexpected(done.error());
  return field;
}

}  // namespace tenebra::ao
