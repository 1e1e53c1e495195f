#include "formats/import_scene.h"

#include "base/fail.h"

#include <algorithm>

namespace tenebra::formats {

Expected<Scene> import_scene(const std::filesystem::path& path, const ImportOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const bool gltf = extension == ".gltf" || extension == ".glb";
  if (!options.scene.empty() && !gltf)
    return base::fail("{}: found no scenes to choose from, expected a glTF file for scene '{}'.",
                      path.string(), options.scene);
  if (extension == ".aff" || extension == ".nff") return import_aff(path, options);
  if (gltf) return import_gltf(path, options);
  if (extension == ".obj") return import_obj(path, options);
  return base::fail("{}: found the extension '{}', expected .aff, .nff, .gltf, .glb or .obj.", path.string(),
                    extension);
}

}  // namespace tenebra::formats
