// What the open dialog lists: the folders and scene files of one folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::viewer {

struct FolderEntry {
  std::string name;
  bool folder = false;
};

struct FolderList {
  static constexpr std::size_t most_entries = 10'000;

  std::filesystem::path folder;      ///< absolute, without . and ..
  std::vector<FolderEntry> entries;  ///< folders first, each by name whatever the case; hidden ones left out
  bool cut = false;                  ///< there are more
};

bool is_scene_name(const std::string& name);  ///< by its extension, whatever the case

/// Fails with a sentence on what is no folder, or cannot be read.
Expected<FolderList> list_folder(const std::filesystem::path& folder);

/// What a user typed, from `folder`: absolute, "~" as $HOME, or relative.
std::filesystem::path typed_path(const std::string& text, const std::filesystem::path& folder);

/// Whether `name` contains `part`, whatever the case.
bool matches(const std::string& name, const std::string& part);

}  // namespace tenebra::viewer
