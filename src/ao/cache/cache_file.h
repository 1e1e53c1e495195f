// Files that keep data from one process to the next: compressed without loss, named by a key of everything
// that the data depends on, and trusted only if every byte is as it was written. Any number of processes may
// share a folder: a file is whole or absent, and whatever two of them write under one key is right.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::ao {

/// 128 bits of XXH3.
struct CacheKey {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  friend bool operator==(const CacheKey&, const CacheKey&) = default;
};
/// Of the parts and their lengths.
CacheKey cache_key(std::initializer_list<std::span<const std::byte>> parts);

/// What such a file holds.
struct CacheKind {
  std::array<char, 8> magic;
  std::uint32_t version;  ///< counts up whenever the same key gives other bytes, or the file has another form
  const char* name;       ///< for messages, and the end of the file's name
};

/// FOLDER/KEY.NAME, the key in hexadecimal.
std::filesystem::path cache_path(const std::filesystem::path& folder, const CacheKind& kind,
                                 const CacheKey& key);

/// Whether something has this name, whatever it is.
bool cache_file_exists(const std::filesystem::path& path);

/// Creates the folder if it is missing. Fails, without waiting, where something other than a file is in the
/// way.
Expected<void> save_cache_file(const std::filesystem::path& folder, const CacheKind& kind,
                               const CacheKey& key, std::string_view bytes);

/// A file that was found to be whole.
class CacheReader {
public:
  /// What was saved, `least` to `most` bytes: memory is bounded by the latter, whatever the file says. A
  /// sentence if the file is missing, no regular file, damaged, cut short, of another kind, version, size or
  /// key.
  static Expected<CacheReader> open(const std::filesystem::path& folder, const CacheKind& kind,
                                    const CacheKey& key, std::size_t least, std::size_t most);

  std::size_t bytes() const { return plain_bytes_; }
  /// Unpacks from the start, until all parts are full.
  Expected<void> read(std::span<const std::span<std::byte>> parts) const;

private:
  CacheReader() = default;
  std::filesystem::path path_;
  std::string file_;
  std::size_t plain_bytes_ = 0;
};

}  // namespace tenebra::ao
