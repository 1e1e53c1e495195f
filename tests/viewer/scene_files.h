// The scenes that rules about pictures are tested on.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

namespace tenebra::testing {

/// The bundled scenes and, where they lie beside the checkout, the sample models and BART's, sorted.
inline std::vector<std::filesystem::path> scene_files() {
  namespace fs = std::filesystem;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(TENEBRA_SCENES_DIR))
    if (entry.path().extension() == ".glb") found.push_back(entry.path());
  const fs::path shared = fs::path(TENEBRA_SHARED_DIR) / "scenes";
  if (fs::exists(shared)) {
    for (const auto& folder : {shared / "extra/gltf", shared / "extra/obj"})
      for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (const auto kind = entry.path().extension(); kind == ".gltf" || kind == ".glb" || kind == ".obj")
          found.push_back(entry.path());
    for (const char* file : {"robots/Robot.aff", "museum/museum5.aff", "kitchen/kitchen.aff"})
      found.push_back(shared / "bart" / file);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace tenebra::testing
