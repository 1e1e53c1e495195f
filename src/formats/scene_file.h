// Files of a scene, read whole under a size cap and never from outside the scene's folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::formats {

/// Largest scene file or buffer that is read.
inline constexpr std::uintmax_t max_scene_file_bytes = std::uintmax_t{1} << 31;

/// Of a regular file. Throws ImportFailure: missing, not a file, too large.
std::uintmax_t scene_file_size(const std::filesystem::path& path);

/// The bytes of a regular file, whose path `files_read` gets if there is one. Throws ImportFailure as
/// scene_file_size does, and where it is unreadable.
std::string read_scene_file(const std::filesystem::path& path,
                            std::vector<std::filesystem::path>* files_read);

/// What stands after the last slash of either kind: names in a file may be paths of another machine.
inline std::string_view last_part(std::string_view name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

/// `uri` with its %XX undone. Throws ImportFailure naming `place`.
std::string undo_percent(std::string_view uri, std::string_view place);

/// `uri` of a scene in `folder` as a path inside `root`, or where that is empty inside the folder, with
/// percent-encoding undone, backslashes as slashes, links resolved. Throws ImportFailure naming `place` for
/// schemes, absolute paths, control characters, links that lead out, and `..` where there is no `root`.
std::filesystem::path confine(const std::filesystem::path& folder, std::string_view uri,
                              std::string_view place, bool percent_encoded,
                              const std::filesystem::path& root = {});

}  // namespace tenebra::formats
