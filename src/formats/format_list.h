// Which kinds of files are read, by which reader, and what to do about others.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/import_scene.h"

namespace tenebra::formats {

struct FileFormat {
  std::string_view extensions;  ///< in lower case, with their dots, a blank between two
  std::string_view name;
  std::string_view reader;  ///< "own" or the library's name
  std::string_view kept;    ///< what of such files is read
  bool states_coordinates;  ///< which axis is up and what the unit is
  Expected<Scene> (*read)(const std::filesystem::path&, const ImportOptions&);  ///< places the scene, too
};

std::span<const FileFormat> file_formats();

/// By the extension of `file`, whatever its case; null: not read.
const FileFormat* format_of(const std::filesystem::path& file);

/// How a file with an extension that is not read becomes one that is: "in Blender: File > Export > glTF 2.0".
std::string_view way_to_gltf(const std::filesystem::path& file);

}  // namespace tenebra::formats
