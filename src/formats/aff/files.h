// The files of an AFF scene: found within the scene's folder only, read once each, kept for repeated
// includes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tenebra::formats {

struct AffFile {
  std::string name;              ///< without folder
  std::filesystem::path folder;  ///< canonical
  std::string text;
  bool open = false;  ///< being read: to include it now would be a cycle
};

/// Functions throw AffFailure with what is wrong with the file; the caller adds the place.
class AffFiles {
public:
  AffFile& open_top(const std::filesystem::path& path);
  /// Looks beside `from`, then in the top file's folder.
  AffFile& open_include(std::string_view name, const AffFile& from);
  /// Adds the paths of all that was read, sorted.
  void list(std::vector<std::filesystem::path>& paths) const;
  std::uint64_t bytes_read() const { return bytes_read_; }
  /// The top file's folder, canonical.
  const std::filesystem::path& root() const { return root_; }

private:
  AffFile& load(const std::filesystem::path& canonical);

  std::filesystem::path root_;
  std::map<std::filesystem::path, std::unique_ptr<AffFile>> files_;
  std::map<std::pair<const AffFile*, std::string>, AffFile*, std::less<>> resolved_;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace tenebra::formats
