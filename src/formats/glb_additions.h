// What export_glb writes beside a scene, for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>

namespace tenebra::formats {

struct GlbAdditions {
  std::string attribute;                    ///< of vertices; begins with _, as glTF wants it
  std::vector<std::vector<float>> numbers;  ///< for each mesh one for each vertex, or empty: it has none
  std::vector<std::pair<std::string, std::string>> notes;  ///< names and texts: extras of the shown scene
};

/// As export_glb of import_scene.h.
Expected<std::vector<std::string>> export_glb(const Scene& scene, const std::filesystem::path& path,
                                              double fps, const GlbAdditions& additions);

}  // namespace tenebra::formats
