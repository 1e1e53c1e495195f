// The pictures of one scene while it is imported: found in the folders that may be read, decoded once each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
  /// The normal map that a bump map is or stands for; white is a hundredth of the picture's longer side
  /// higher than black, times `scale`. -1 for -1.
  int normals_of_bumps(int bumps, float scale);
  /// The colours of one picture (-1: white) with the other as its alpha, as with_alpha() says; -1 where the
  /// second is.
  int with_alpha(int colors, int shares);
  /// Two pictures (-1: white) as metallic_roughness() joins them; -1 where both are. One picture for both is
  /// taken as it is: grey, or packed as glTF does it.
  int metallic_roughness(int roughness, int metallic);
  /// Whether the alpha of picture `image` says yes or no, as cuts_out() says.
  bool cuts_out(int image);

private:
  std::filesystem::path search(const std::string& name, const std::string& place, bool percent_encoded);
  int load(const std::string& name, const std::string& place, bool percent_encoded);
  int fail(const std::string& name, const std::string& why);
  /// Adds what `make` makes, once there is room for its pixels.
  int derive(const std::string& name, int width, int height, const std::function<TextureImage()>& make);
  /// The picture that `join` makes of two (-1: white), once for each pair.
  int join(int a, int b, TextureImage (*join)(const TextureImage&, const TextureImage&),
           std::map<std::pair<int, int>, int>& known);

  Scene& scene_;
  std::vector<std::filesystem::path> folders_;          ///< the scene's and two in it, then the texture paths
  std::filesystem::path root_;                          ///< ImportOptions'
  std::vector<std::filesystem::path>* files_read_;      ///< ImportOptions'
  std::map<std::string, int> index_of_;                 ///< by name in the scene file
  std::map<std::filesystem::path, int> index_of_file_;  ///< by place on disk
  std::map<std::pair<int, float>, int> normals_of_;     ///< by bump map and scale
  std::map<std::pair<int, int>, int> with_alpha_, metallic_roughness_;  ///< by both pictures
  std::map<int, bool> holds_heights_, cuts_out_;  ///< by picture: what derived.h says of it
  std::uint64_t pixels_left_ = most_scene_pixels;
};

}  // namespace tenebra::formats
