// An Assimp scene as a binary glTF.
#pragma once

#include <assimp/scene.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tenebra::converter {

using Json = nlohmann::json;  // whose members stay in place when others are added

/// The tables and the bytes of a glTF file.
class Glb {
public:
  Json json{{"asset", {{"version", "2.0"}, {"generator", "tenebra-assimp"}}}};

  /// Appends to the list `name`; returns its index.
  std::size_t add(const char* name, Json entry);
  std::size_t add_view(const void* bytes, std::size_t size);
  /// `values`: `count` elements of `type`, of floats (5126), unsigned (5125) or short (5123) integers.
  std::size_t add_accessor(const void* values, std::size_t count, int component, const char* type);
  void write(std::FILE* file);

private:
  std::string bytes_;
};

/// Names of pictures, as they are found: `name` beside the scene in `folder`, else the last part of it.
std::string picture_uri(const std::filesystem::path& folder, std::string name);

class GltfWriter {
public:
  /// `scene` must outlive this; `folder` is that of the file.
  GltfWriter(const aiScene& scene, const std::filesystem::path& folder);
  void write(std::FILE* file) { glb_.write(file); }
  const std::vector<std::string>& left_out() const { return left_out_; }  ///< sentences

private:
  void leave_out(const char* sentence);        ///< says it once
  bool is_of(std::string_view program) const;  ///< by what Assimp calls the format

  void add_materials();
  Json material(const aiMaterial& source, bool all_clear);
  Json phong(const aiMaterial& source);
  Json texture(const aiMaterial& source, aiTextureType type);
  std::size_t image(const std::string& name);

  void add_nodes();
  Json mesh_of(const aiNode& node);
  Json primitive(const aiMesh& mesh);
  Json morph_targets(const aiMesh& mesh);
  void even_out_targets(Json& primitives);
  void add_colors_and_coordinates(const aiMesh& mesh, Json& attributes);
  void add_influences(const aiMesh& mesh, const std::map<std::string, std::uint16_t>& joints,
                      Json& attributes);
  void add_skin(const aiNode& node, Json& written);

  void add_lights();
  void add_cameras();
  void hang(const aiString& name, const aiMatrix4x4& placed, Json content);
  void add_animations();
  void add_weights(const aiMeshMorphAnim& source, double ticks_per_second, Json& animation);
  void add_track(const std::vector<float>& times, const std::vector<float>& values, const char* type,
                 const char* path, std::size_t node, Json& animation);

  const aiScene& scene_;
  std::filesystem::path folder_;
  Glb glb_;
  std::vector<std::string> left_out_;
  std::vector<const aiNode*> nodes_;                ///< of glTF's first nodes
  std::map<std::string, std::size_t> node_index_;   ///< the first of each name
  std::map<std::string, std::size_t> image_index_;  ///< textures by the picture's name
  std::map<const aiMesh*, Json> primitive_of_;      ///< those that are written
  std::map<std::vector<const aiMesh*>, std::size_t> mesh_index_;
};

}  // namespace tenebra::converter
