// From a scene file to a Scene, by the reader that format_list.h names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "formats/placement.h"

namespace tenebra::formats {

struct ImportOptions {
  int cone_sides = 64;  ///< AFF `c`: sides of a cone or cylinder (the 2011 paper's count needs 8)
  std::string scene;  ///< glTF: which of the file's scenes, by name or number; empty: the one it shows first
  Placement placement;          ///< import_obj, import_ply, import_stl follow it; else import_scene does
  bool keep_unrounded = false;  ///< fill Mesh::unrounded where positions are rounded
  /// Files that the scene names may lie anywhere in this folder, by `..` too; empty: in the scene's folder.
  std::filesystem::path root = {};
  /// Where pictures are looked for that are not beside the scene.
  std::vector<std::filesystem::path> texture_paths;
  /// Gets each file that the scene was read from, in an order that is the same at each import; null: not
  /// asked for.
  std::vector<std::filesystem::path>* files_read = nullptr;
};

/// Imports by the file's extension (file_formats). Never crashes, hangs or leaves the scene's
/// folder (ImportOptions::root); what leaves the geometry in doubt it refuses in one sentence (file, line or
/// JSON path, found, expected), and warns of other faults.
/// Pictures are read from the scene's folder, its folders textures and TextureFiles, and the texture paths;
/// one that is missing, broken or too large is a warning. Needs at most 256 MiB + 20 times the files' size
/// (compressed geometry counts as what it decodes to, up to 16 times its size), and four bytes per pixel of
/// the pictures used (2^26 pixels each, 2^27 together, at most; images/decode.h). By Assimp also what the
/// converter may use (docs/import.md), and 20 times what it writes. Does not add cameras or lights.
Expected<Scene> import_scene(const std::filesystem::path& path, const ImportOptions& options = {});

Expected<Scene> import_aff(const std::filesystem::path& path, const ImportOptions& options);
Expected<Scene> import_gltf(const std::filesystem::path& path, const ImportOptions& options = {});
Expected<Scene> import_obj(const std::filesystem::path& path, const ImportOptions& options = {});
Expected<Scene> import_ply(const std::filesystem::path& path, const ImportOptions& options = {});
Expected<Scene> import_stl(const std::filesystem::path& path, const ImportOptions& options = {});

/// Writes `scene` with its animation as a binary glTF 2.0 file. BART's splines are baked to `fps` keys a
/// second (the clip's own frames where it states them); shapes become morph targets. Returns what glTF cannot
/// hold, one sentence each. What other programs do not read stands in `extras` for import_gltf: lights
/// without falloff, ambient factors, reflectances above 1, Phong's specular, untinted transmission, what
/// colours are, shadow flags, ambient light, background. Pictures are embedded as PNG.
Expected<std::vector<std::string>> export_glb(const Scene& scene, const std::filesystem::path& path,
                                              double fps = 30.0);

}  // namespace tenebra::formats
