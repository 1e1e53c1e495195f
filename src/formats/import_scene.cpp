#include "formats/import_scene.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <string_view>

#include "base/fail.h"
#include "base/lower_case.h"
#include "formats/format_list.h"
#include "formats/place_scene.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

/// The first scene file of `folder` by name, or empty.
fs::path scene_in(const fs::path& folder) {
  fs::path first;
  std::error_code error;
  // Not by a range: its ++ throws where a folder cannot be read to its end.
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path& path = at->path();
    if (format_of(path) != nullptr && (first.empty() || path < first)) first = path;
  }
  return first;
}

/// What users open in place of a scene, by its first bytes, and what to do; empty: none of these.
std::string other_content(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const fs::path scene = scene_in(path);
    return "found a folder, expected a scene file: open " +
           (scene.empty() ? "a file in it" : scene.filename().string() + " in it");
  }
  std::array<char, 32> first{};
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  stream.read(first.data(), first.size());
  if (stream.bad()) return {};  // the reader has the reason
  const std::string_view bytes(first.data(), static_cast<std::size_t>(stream.gcount()));
  if (bytes.empty()) return "found an empty file, expected a scene: copy it again";
  const FileFormat* const format = format_of(path);
  const bool may_be_zip = format != nullptr && format->reader == "Assimp";  // as 3MF is
  const bool is_blend = base::extension_of(path) == ".blend";               // which Blender may compress
  for (const std::string_view archive : {"PK\x03\x04", "Rar!", "7z\xBC\xAF", "\x1F\x8B"})
    if (bytes.starts_with(archive) && !is_blend && !(may_be_zip && bytes.starts_with("PK")))
      return "found an archive, expected a scene: unpack it and open the scene in it";
  if (bytes.starts_with("version https://git-lfs"))
    return "found a note of Git LFS in place of the file, expected a scene: fetch it by 'git lfs pull'";
  for (const std::string_view page : {"<!DOCTYPE", "<!doctype", "<html", "<HTML"})
    if (bytes.starts_with(page))
      return "found a web page, expected a scene: download the file itself, not the page that shows it";
  return {};
}

/// Says where nothing of the scene can be seen. What a clip shows at a time is not looked at.
void warn_of_nothing(Scene& scene) {
  std::size_t triangles = 0, solid = 0, shown = 0;
  std::vector<bool> visible;
  const auto is_solid = [&](std::uint32_t index) {
    const Material& material = scene.materials[index];
    if (material.alpha_mode == AlphaMode::mask) return material.alpha >= material.alpha_cutoff;
    return material.alpha_mode == AlphaMode::opaque || material.alpha > 0;
  };
  for (const Node& node : scene.nodes) {
    visible.push_back(node.visible && (node.parent < 0 || visible[static_cast<std::size_t>(node.parent)]));
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    triangles += mesh.triangles.size();
    if (visible.back()) shown += mesh.triangles.size();
    if (solid == 0) solid += std::any_of(mesh.materials.begin(), mesh.materials.end(), is_solid);
  }
  if (triangles == 0)
    scene.warnings.push_back("The scene has no triangles: there is nothing to see.");
  else if (solid == 0)
    scene.warnings.push_back(
        "All materials have alpha 0, or one below their cutoff: there is nothing to see.");
  else if (shown == 0)
    scene.warnings.push_back("All nodes with triangles are hidden: there is nothing to see.");
}

/// By the file's extension.
Expected<Scene> read_scene(const fs::path& path, const ImportOptions& options) {
  if (const std::string other = other_content(path); !other.empty())
    return base::fail("{}: {}.", path.string(), other);
  const FileFormat* const format = format_of(path);
  if (format == nullptr)
    return base::fail("{}: found the extension '{}', expected one that 'tenebra info --formats' lists: {}.",
                      path.string(), path.extension().string(), way_to_gltf(path));
  if (!options.scene.empty() && format->read != format_of("a.glb")->read)
    return base::fail("{}: found no scenes to choose from, expected a glTF file for scene '{}'.",
                      path.string(), options.scene);
  return format->read(path, options);
}

}  // namespace

Expected<Scene> import_scene(const fs::path& path, const ImportOptions& options) {
  try {
    auto scene = read_scene(path, options);
    if (!scene) return scene;
    warn_of_nothing(*scene);
    warn_of_tolerance(*scene);
    return scene;
  } catch (const std::bad_alloc&) {
    return base::fail("{}: found more than the memory can hold, expected a smaller scene.", path.string());
  }
}

}  // namespace tenebra::formats
