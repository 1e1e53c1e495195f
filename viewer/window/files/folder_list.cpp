#include "window/files/folder_list.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "base/fail.h"
#include "base/lower_case.h"
#include "formats/format_list.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

}  // namespace

bool is_scene_name(const std::string& name) {
  return formats::format_of(name) != nullptr;
}

Expected<FolderList> list_folder(const fs::path& folder) {
  std::error_code error;
  FolderList list{fs::absolute(folder, error).lexically_normal(), {}, false};
  if (!list.folder.has_filename()) list.folder = list.folder.parent_path();  // "a/" as "a"
  fs::directory_iterator entry(list.folder, fs::directory_options::skip_permission_denied, error);
  if (error) return base::fail("{}: {}", list.folder.string(), error.message());
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code none;
    const bool is_folder = entry->is_directory(none);
    if (name.starts_with('.') || (!is_folder && (!is_scene_name(name) || !entry->is_regular_file(none))))
      continue;
    if (list.entries.size() == FolderList::most_entries) {
      list.cut = true;
      break;
    }
    list.entries.push_back({name, is_folder});
  }
  if (error) return base::fail("{}: {}", list.folder.string(), error.message());
  std::sort(list.entries.begin(), list.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    const std::string left = base::lower_case(a.name), right = base::lower_case(b.name);
    return std::tie(b.folder, left, a.name) < std::tie(a.folder, right, b.name);
  });
  return list;
}

fs::path typed_path(const std::string& text, const fs::path& folder) {
  const char* home = std::getenv("HOME");
  if (home != nullptr && (text == "~" || text.starts_with("~/")))
    return fs::path(home) / text.substr(std::min<std::size_t>(2, text.size()));
  return (folder / text).lexically_normal();
}

bool matches(const std::string& name, const std::string& part) {
  return base::lower_case(name).find(base::lower_case(part)) != std::string::npos;
}

}  // namespace tenebra::viewer
