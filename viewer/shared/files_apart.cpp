#include "shared/files_apart.h"

#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <optional>
#include <system_error>

#include "base/fail.h"
#include "base/output_stream.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

/// Fails for an output that nothing can be written to in the way that open_stream says.
Expected<void> check_kind(const fs::path& output) {
  struct stat found {};
  if (::stat(output.c_str(), &found) != 0) {
    if (errno == ENOENT) return {};
    return base::fail("cannot write {}: {}", output.string(), std::generic_category().message(errno));
  }
  const auto stream = base::open_stream(output, found);
  return stream ? Expected<void>() : tl::unexpected(stream.error());
}

/// Finds out which file a name means.
class FileIdentities {
public:
  /// The same text for the same file; none for what is no regular file.
  std::optional<std::string> of(const fs::path& file) {
    struct stat found {};
    if (::stat(file.c_str(), &found) != 0) return (folder_of(file) / file.filename()).string();
    if (!S_ISREG(found.st_mode)) return {};
    return fmt::format("{}:{}", found.st_dev, found.st_ino);
  }

private:
  const fs::path& folder_of(const fs::path& file) {
    const auto [entry, is_new] = folders_.try_emplace(file.parent_path());
    if (!is_new) return entry->second;
    std::error_code error;
    entry->second = fs::weakly_canonical(entry->first.empty() ? fs::path(".") : entry->first, error);
    if (error) entry->second = entry->first;
    return entry->second;
  }

  std::map<fs::path, fs::path> folders_;  ///< canonical, by how outputs name them
};

}  // namespace

Expected<void> check_files_apart(const std::vector<fs::path>& inputs,
                                 const std::vector<OutputName>& outputs) {
  FileIdentities identities;
  std::map<std::string, OutputName> known;
  for (const fs::path& input : inputs)
    if (const auto identity = identities.of(input)) known.try_emplace(*identity, OutputName{"", input});
  for (const OutputName& output : outputs) {
    if (auto checked = check_kind(output.file); !checked) return checked;
    const auto identity = identities.of(output.file);
    if (!identity) continue;
    const auto [entry, is_new] = known.try_emplace(*identity, output);
    if (is_new) continue;
    const OutputName& other = entry->second;
    if (other.option.empty())
      return base::fail("{} {} is the file {} that is read, and would overwrite it; expected another name",
                        output.option, output.file.string(), other.file.string());
    return base::fail("{} {} and {} {} are the same file; expected two names", other.option,
                      other.file.string(), output.option, output.file.string());
  }
  return {};
}

}  // namespace tenebra::viewer
