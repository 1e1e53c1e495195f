#include "formats/import_scene.h"

#include <algorithm>

#include "base/fail.h"
#include "formats/place_scene.h"

namespace tenebra::formats {
namespace {

Expected<Scene> placed(Expected<Scene> scene, const Placement& placement) {
  if (scene) place_scene(placement, *scene);
  return scene;
}

/// By the file's extension.
Expected<Scene> read_scene(const std::filesystem::path& path, const ImportOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const bool gltf = extension == ".gltf" || extension == ".glb";
  if (!options.scene.empty() && !gltf)
    return base::fail("{}: found no scenes to choose from, expected a glTF file for scene '{}'.",
                      path.string(), options.scene);
  if (extension == ".aff" || extension == ".nff") {
    Placement placement = options.placement;  // BART's scenes keep their floats: pictures of them are compared
    if (placement.offset == OffsetChoice::automatic) placement.offset = OffsetChoice::none;
    return placed(import_aff(path, options), placement);
  }
  if (gltf) return placed(import_gltf(path, options), options.placement);
  if (extension == ".obj") return import_obj(path, options);
  return base::fail("{}: found the extension '{}', expected .aff, .nff, .gltf, .glb or .obj.", path.string(),
                    extension);
}

}  // namespace

Expected<Scene> import_scene(const std::filesystem::path& path, const ImportOptions& options) {
  auto scene = read_scene(path, options);
  if (scene) warn_of_tolerance(*scene);
  return scene;
}

}  // namespace tenebra::formats
