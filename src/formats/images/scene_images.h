// The pictures of one scene while it is imported: found in the folders that may be read, decoded once each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/scene.h>
#include "formats/images/decode.h"
#include "formats/import_scene.h"

namespace tenebra::formats {

/// Fills Scene::images. A picture that is missing or broken costs a warning with its name, once.
class SceneImages {
public:
  /// `folder` is the scene's. `scene` must live as long.
  SceneImages(Scene& scene, const std::filesystem::path& folder, const ImportOptions& options);

  /// Index into Scene::images of the picture that a scene file calls `name`, or -1. Looks beside the scene,
  /// in its folders textures and TextureFiles, then in the texture paths; there also by the last part of a
  /// name with folders. `place` says in the warning where the name stands.
  int find(const std::string& name, const std::string& place);
  /// The picture that a URI of a glTF file names: percent-encoded, never by its last part alone.
  int find_uri(const std::string& uri, const std::string& place);
  /// A picture whose bytes are at hand.
  int add(std::string_view bytes, const std::string& name);

private:
  std::filesystem::path search(const std::string& name, const std::string& place, bool percent_encoded);
  int load(const std::string& name, const std::string& place, bool percent_encoded);
  int fail(const std::string& name, const std::string& why);

  Scene& scene_;
  std::vector<std::filesystem::path> folders_;          ///< the scene's and two in it, then the texture paths
  std::filesystem::path root_;                          ///< ImportOptions'
  std::vector<std::filesystem::path>* files_read_;      ///< ImportOptions'
  std::map<std::string, int> index_of_;                 ///< by name in the scene file
  std::map<std::filesystem::path, int> index_of_file_;  ///< by place on disk
  std::uint64_t pixels_left_ = most_scene_pixels;
};

}  // namespace tenebra::formats
