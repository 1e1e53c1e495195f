// What export_glb is made of: the JSON and binary chunk being built, one method for each table of the file.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/scene.h>
#include "formats/glb_additions.h"
#include "formats/import_failure.h"

namespace tenebra::formats {

using GlbJson = nlohmann::ordered_json;

inline GlbJson to_json(const glm::vec3& v) {
  return GlbJson::array({v.x, v.y, v.z});
}

/// All tables of a file, each null until something is in it. They stand from the start, so that a reference
/// to one is not moved by a new one beside it.
inline GlbJson empty_tables() {
  GlbJson root = {{"asset", {{"version", "2.0"}, {"generator", "Tenebra"}}}};
  for (const char* name : {"extensionsUsed", "extensionsRequired", "scene", "scenes", "nodes", "meshes",
                           "accessors", "bufferViews", "buffers", "materials", "textures", "images",
                           "samplers", "cameras", "skins", "animations", "extensions"})
    root[name] = nullptr;
  return root;
}

/// The largest of 1 and the components: glTF's colours end at 1.
inline float peak_of(const glm::vec3& color) {
  return std::max({color.x, color.y, color.z, 1.0f});
}

/// The binary chunk and the tables that describe it.
struct GlbBinary {
  static constexpr std::size_t max_bytes = 0xFFFFFFFF;  ///< lengths in a GLB are 32 bits

  GlbJson& root;
  std::string bytes;
  std::size_t not_finite = 0;  ///< values written that glTF forbids

  /// One accessor over elements of `components` values; bounds on request (positions, key times). Throws
  /// ImportFailure when a GLB cannot hold it.
  template <class T>
  int add(const std::vector<T>& values, int components, int component_type, bool bounds) {
    static const std::map<int, const char*> types = {
        {1, "SCALAR"}, {2, "VEC2"}, {3, "VEC3"}, {4, "VEC4"}, {16, "MAT4"}};
    GlbJson accessor = {{"bufferView", add_view(values.data(), values.size() * sizeof(T))},
                        {"componentType", component_type},
                        {"count", values.size() / static_cast<std::size_t>(components)},
                        {"type", types.at(components)}};
    if (bounds) add_bounds(accessor, values, static_cast<std::size_t>(components));
    root["accessors"].push_back(std::move(accessor));
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  /// A view of its own over a copy of `size` bytes. Throws as add() does.
  std::size_t add_view(const void* data, std::size_t size) {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    const std::size_t offset = bytes.size();
    if (size > max_bytes - offset)
      refuse("found more than {} bytes to write, expected at most that in a GLB", max_bytes);
    bytes.resize(offset + size);
    std::memcpy(bytes.data() + offset, data, size);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    return root["bufferViews"].size() - 1;
  }

  int add_floats(const std::vector<float>& values, int components, bool bounds);
  int add_vec3(const std::vector<glm::vec3>& values, bool bounds);

private:
  template <class T>
  static void add_bounds(GlbJson& accessor, const std::vector<T>& values, std::size_t components) {
    for (std::size_t c = 0; c < components; ++c) {
      T low = std::numeric_limits<T>::max(), high = std::numeric_limits<T>::lowest();
      for (std::size_t i = c; i < values.size(); i += components)
        if (std::isfinite(values[i])) low = std::min(low, values[i]), high = std::max(high, values[i]);
      accessor["min"].push_back(std::min(low, high));
      accessor["max"].push_back(std::max(low, high));
    }
  }
};

/// One scene on its way into a GLB.
class GlbWriter {
public:
  GlbWriter(const Scene& scene, double fps, const GlbAdditions& additions);

  /// The file's bytes. Throws ImportFailure when a GLB cannot hold the scene.
  std::string write();
  /// What glTF cannot hold, one sentence each.
  std::vector<std::string> losses;

private:
  // materials.cpp
  void write_materials();
  GlbJson write_material(const Material& source);
  void write_reflection(const Material& source, GlbJson& material);
  void write_dielectric(const Material& source, GlbJson& material);
  void write_relief(const Material& source, GlbJson& material);
  void write_emission(const Material& source, GlbJson& material);
  void write_transmission(const Material& source, GlbJson& material);
  void name_what_others_miss();

  // textures.cpp
  /// Adds a reference to the picture as member `name` of `object`, if there is one.
  void write_map(const TextureMap& map, const char* name, GlbJson& object);
  void write_transform(const glm::mat3x2& transform, GlbJson& info);
  int texture_of(const TextureMap& map);
  int sampler_of(const TextureMap& map);
  int image_of(int image);

  // tables.cpp
  void write_lights();
  void write_cameras();
  void write_skins();
  std::vector<double> light_distances() const;
  void use(const char* extension);

  // meshes.cpp
  void write_meshes();
  void write_primitives(std::size_t index, GlbJson& written);

  // nodes.cpp
  void find_hidden_nodes();
  void write_transform(std::size_t index, GlbJson& written);
  void write_contents(std::size_t index, GlbJson& written);
  void write_nodes();
  int written_mesh(std::size_t node) const;

  // animations.cpp
  struct ClipWriter;
  void write_clips();

  const Scene& scene_;
  double fps_;
  const GlbAdditions& additions_;
  GlbJson root_ = empty_tables();
  GlbBinary binary_{root_, {}};
  std::vector<int> mesh_of_;   ///< mesh of the file for each of the scene; -1: no triangles
  std::vector<int> light_of_;  ///< index in its extension's table
  std::vector<int> skin_of_;   ///< skin of the file for each of the scene; -1: none, as no node uses it
  std::vector<double> intensity_factor_, color_factor_;  ///< of each light, from the scene's to the file's
  std::vector<bool> hidden_;                             ///< nodes that no clip ever shows
  std::map<int, int> image_of_;                          ///< image of the file by that of the scene
  std::map<std::array<int, 4>, int> sampler_of_;         ///< by its four numbers in the file
  std::map<std::pair<int, int>, int> texture_of_;        ///< by image and sampler in the file
  std::size_t skewed_ = 0;                               ///< transforms of textures that glTF cannot express
};

}  // namespace tenebra::formats
