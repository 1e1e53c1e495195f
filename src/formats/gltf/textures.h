// Textures of a glTF file: its images, decoded when a material first uses one, and how they are sampled.
#pragma once

#include <map>

#include "formats/gltf/model.h"
#include "formats/images/scene_images.h"

namespace tenebra::formats::gltf {

class Textures {
  struct Use {
    int texture = -1;
    int uv_set = 0;
    const Value* transform = nullptr;
  };

public:
  /// Warns of images whose place or kind is not allowed, used or not.
  Textures(Asset& asset, const std::filesystem::path& folder, SceneImages images);

  /// What a texture of a material is: `info`, tinygltf's of any kind, says which and by which coordinates. No
  /// map where its picture cannot be read.
  template <class Info>
  TextureMap map(const Info& info, const std::string& place) {
    const auto found = info.extensions.find("KHR_texture_transform");
    return map({info.index, info.texCoord, found == info.extensions.end() ? nullptr : &found->second}, place);
  }
  /// The texture that an extension has as its member `name`; no map without one.
  TextureMap map(const Value& extension, const char* name, const std::string& place);

private:
  TextureMap map(Use use, const std::string& place);
  int image_of(int texture, const std::string& place);
  int image(int index);
  const Value* source(int index) const;
  void check_source(int index, const std::filesystem::path& folder);
  void check_kind(int index);

  Asset& asset_;
  SceneImages images_;
  std::map<int, int> known_;  ///< index into Scene::images by that in the file; -1: cannot be read
};

}  // namespace tenebra::formats::gltf
