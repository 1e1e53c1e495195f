// import_obj: Wavefront OBJ as exporters write it.
#include <algorithm>
#include <optional>

#include "formats/file_points.h"
#include "formats/import_guard.h"
#include "formats/import_scene.h"
#include "formats/obj/build.h"
#include "formats/obj/mtl.h"
#include "formats/scene_file.h"
#include "formats/text_lines.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

/// `name` beside the scene; of a name with folders that are not there, or are of another machine, the last
/// part. Nothing where there is no such file.
std::optional<fs::path> find_library(const fs::path& folder, const fs::path& root, std::string_view name) {
  for (const std::string_view part : {name, last_part(name)}) {
    try {
      const fs::path file = confine(folder, part, "mtllib", false, root);
      std::error_code error;
      if (fs::is_regular_file(file, error)) return file;
    } catch (const ImportFailure&) {
      continue;  // leads out of the folder, or is no name
    }
  }
  return std::nullopt;
}

/// The files that `mtllib WRITTEN` names: the whole rest of the line if there is such a file, else each word;
/// of these there is none, the file of the scene's own name.
std::vector<fs::path> library_files(const fs::path& scene, const fs::path& root, std::string_view written,
                                    std::vector<std::string>& warnings) {
  const fs::path folder = scene.parent_path();
  for (const std::string_view whole : {written, without_comment(written)})
    if (const auto file = find_library(folder, root, whole)) return {*file};
  std::vector<fs::path> files;
  std::vector<std::string> missing;
  constexpr int most_words = 64;
  std::string_view rest = written;
  for (int i = 0; i < most_words; ++i) {
    const std::string_view word = take_word(rest);
    if (word.empty()) break;
    if (const auto file = find_library(folder, root, word))
      files.push_back(*file);
    else
      missing.push_back(fmt::format(
          "mtllib '{}': found no such file beside the scene; its materials are grey.", shown(word)));
  }
  const std::string namesake = fs::path(scene).replace_extension(".mtl").filename().string();
  if (files.empty() && !missing.empty())
    if (const auto file = find_library(folder, root, namesake)) {
      files.push_back(*file);
      missing = {fmt::format("mtllib '{}': found no such file beside the scene; {} is read in its place.",
                             shown(without_comment(written)), shown(namesake))};
    }
  warnings.insert(warnings.end(), missing.begin(), missing.end());
  return files;
}

std::vector<MtlMaterial> read_libraries(const fs::path& path, const ObjFile& file,
                                        const ImportOptions& options, Scene& scene) {
  std::vector<MtlMaterial> materials;
  std::vector<fs::path> read;
  for (const std::string& written : file.libraries)
    for (const fs::path& library : library_files(path, options.root, written, scene.warnings)) {
      if (std::find(read.begin(), read.end(), library) != read.end()) continue;
      read.push_back(library);
      const std::string name = library.filename().string();
      try {
        if (parse_mtl(read_scene_file(library, options.files_read), name, materials, scene.warnings))
          continue;
        scene.warnings.push_back(
            fmt::format("mtllib: found more than {} materials: the others are grey.", most_materials));
        return materials;
      } catch (const UnreadableFile& failure) {
        throw UnreadableFile(fmt::format("mtllib '{}': {}", name, failure.what()));
      } catch (const ImportFailure& failure) {
        scene.warnings.push_back(
            fmt::format("mtllib '{}': {}; its materials are grey.", name, failure.what()));
      }
    }
  return materials;
}

/// Which material each name of the file is; unknown ones are grey, with one warning where others are known.
std::vector<std::uint32_t> materials_of_names(const ObjFile& file, const std::vector<MtlMaterial>& materials,
                                              std::uint32_t grey, Scene& scene) {
  std::vector<std::uint32_t> found;
  std::size_t unknown = 0;
  std::string first;
  for (const int index : find_materials(materials, file.material_names)) {
    if (index < 0 && unknown++ == 0) first = shown(without_comment(file.material_names[found.size()]));
    found.push_back(index < 0 ? grey : static_cast<std::uint32_t>(index));
  }
  if (unknown > 0 && !materials.empty())
    scene.warnings.push_back(
        fmt::format("usemtl '{}'{}: found no such material in the MTL file; its faces are grey.", first,
                    unknown > 1 ? fmt::format(" and {} more", unknown - 1) : ""));
  return found;
}

Scene read_obj(const fs::path& path, const ImportOptions& options) {
  Scene scene;
  scene.name = path.filename().string();
  const ObjFile file = parse_obj(read_scene_file(path, options.files_read));
  scene.warnings = file.warnings;
  const std::vector<MtlMaterial> materials = read_libraries(path, file, options, scene);
  SceneImages images(scene, path.parent_path(), options);
  add_materials(materials, images, scene);
  ObjLooks looks;
  looks.grey = static_cast<std::uint32_t>(materials.size());
  looks.materials = materials_of_names(file, materials, looks.grey, scene);
  looks.frame = scene.frame = choose_frame(options.placement, {}, file.positions);
  looks.keep_unrounded = options.keep_unrounded;
  looks.textured = !scene.images.empty();
  if (add_meshes(file, looks, scene)) scene.materials.emplace_back();
  warn_of_odd_positions(file.positions, scene);
  return scene;
}

}  // namespace

Expected<Scene> import_obj(const fs::path& path, const ImportOptions& options) {
  return guarded_import(path, "an OBJ file", [&] { return read_obj(path, options); });
}

}  // namespace tenebra::formats
