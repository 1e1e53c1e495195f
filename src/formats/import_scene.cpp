#include "formats/import_scene.h"

#include "base/fail.h"

#include <algorithm>

namespace tenebra::formats {

Expected<Scene> import_scene(const std::filesystem::path& path, const ImportOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".aff" || extension == ".nff") return import_aff(path, options);
  if (extension == ".gltf" || extension == ".glb") return import_gltf(path);
  if (extension == ".obj") return import_obj(path);
  return base::fail("{}: found the extension '{}', expected .aff, .nff, .gltf, .glb or .obj.", path.string(),
                    extension);
}

}  // namespace tenebra::formats
