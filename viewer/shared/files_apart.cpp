#include "shared/files_apart.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "base/fail.h"
#include "io/output_stream.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

/// Fails, as open_stream says, for an output that nothing can be written to.
Expected<void> check_kind(const fs::path& output) {
  struct stat found {};
  if (::stat(output.c_str(), &found) != 0) {
    if (errno == ENOENT) return {};
    return base::fail("cannot write {}: {}", output.string(), std::generic_category().message(errno));
  }
  const auto stream = io::open_stream(output, found);
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

/// Which of many texts come twice, in eight bytes each.
class Repeats {
public:
  void add(const std::string& text) { hashes_.push_back(hash_(text)); }
  /// To be called once all are added; true if any does.
  bool find() {
    std::ranges::sort(hashes_);
    std::vector<std::size_t> twice;
    for (std::size_t i = 1; i < hashes_.size(); ++i)
      if (hashes_[i] == hashes_[i - 1]) twice.push_back(hashes_[i]);
    hashes_ = std::move(twice);
    return !hashes_.empty();
  }
  /// After find(): whether this one may.
  bool may_be(const std::string& text) const { return std::ranges::binary_search(hashes_, hash_(text)); }

private:
  std::hash<std::string> hash_;
  std::vector<std::size_t> hashes_;
};

tl::unexpected<Error> refuse_pair(const OutputName& first, const OutputName& second) {
  if (first.option.empty())
    return base::fail("{} {} is the file {} that is read, and would overwrite it; expected another name",
                      second.option, second.file.string(), first.file.string());
  return base::fail("{} {} and {} {} are the same file; expected two names", first.option,
                    first.file.string(), second.option, second.file.string());
}

/// Files that were named, by what they are.
using KnownFiles = std::map<std::string, OutputName>;

void add_inputs(const std::vector<fs::path>& inputs, FileIdentities& identities, KnownFiles& known) {
  for (const fs::path& input : inputs)
    if (const auto identity = identities.of(input)) known.try_emplace(*identity, OutputName{"", input});
}

}  // namespace

Expected<void> check_files_apart(const std::vector<fs::path>& inputs, const OutputNames& outputs) {
  FileIdentities identities;
  KnownFiles known;
  add_inputs(inputs, identities, known);
  Repeats repeats;
  for (const auto& [identity, name] : known) repeats.add(identity);
  const auto look = [&](const OutputName& output) -> Expected<void> {
    if (auto checked = check_kind(output.file); !checked) return checked;
    if (const auto identity = identities.of(output.file)) repeats.add(*identity);
    return {};
  };
  if (auto looked = outputs(look); !looked || !repeats.find()) return looked;
  return outputs([&](const OutputName& output) -> Expected<void> {
    const auto identity = identities.of(output.file);
    if (!identity || !repeats.may_be(*identity)) return {};
    const auto [entry, is_new] = known.try_emplace(*identity, output);
    return is_new ? Expected<void>() : refuse_pair(entry->second, output);
  });
}

Expected<void> check_files_apart(const std::vector<fs::path>& inputs, const OutputName& output) {
  return check_files_apart(inputs, [&](const auto& use) { return use(output); });
}

}  // namespace tenebra::viewer
