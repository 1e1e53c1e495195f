// A glTF file in memory: tinygltf's tables, checked by check_gltf_schema, with the bytes of its buffers.
// The only file that includes tinygltf; the readers of one table each are declared here too.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/scene.h>
#include "formats/import_failure.h"
#include "formats/import_scene.h"

namespace tenebra::formats::gltf {

using Model = tinygltf::Model;
using Accessor = tinygltf::Accessor;
using Value = tinygltf::Value;

/// Bytes that an import may still allocate: small files that claim gigabytes are refused.
class Budget {
public:
  explicit Budget(std::uint64_t bytes) : left_(bytes) {}
  /// Takes count * size bytes; throws ImportFailure naming `place` when they are not there.
  void take(std::uint64_t count, std::uint64_t size, const std::string& place) {
    if (!try_take(count, size))
      refuse("{}: found {} elements, expected at most {} for a file of this size", place, count,
             left_ / size);
  }
  /// The same; false where they are not there.
  bool try_take(std::uint64_t count, std::uint64_t size) {
    if (count > left_ / size) return false;
    left_ -= count * size;
    return true;
  }
  std::uint64_t left() const { return left_; }
  /// Adds what the bytes of one more file allow.
  void give(std::uint64_t bytes) { left_ += bytes; }

private:
  std::uint64_t left_;
};

struct Asset {
  Model model;
  std::vector<std::string> buffers;  ///< bytes of model.buffers
  Budget budget{0};
  std::uint64_t decoded_allowed = 0;  ///< bytes of decoded geometry that may still count as the file's own
  // For each node of the file, by build_nodes:
  std::vector<bool> animated;  ///< a channel drives it
  std::vector<int> parents;    ///< its parent, or -1
  bool scene_chosen = false;   ///< by the user
  /// Nodes of the scene, the first and how many, that show the instances of one.
  std::map<int, std::pair<int, int>> instances;
  Scene scene;                                               ///< what is being built; its warnings too
  std::filesystem::path root;                                ///< ImportOptions'
  std::vector<std::filesystem::path>* files_read = nullptr;  ///< ImportOptions'
};

/// JSON text to model; `binary` is the GLB's chunk. Throws ImportFailure.
void load_model(const std::filesystem::path& path, std::string_view bytes, Asset& asset);

// Compressed geometry becomes buffers, views and accessors like any other. Throw ImportFailure for broken
// data, for more of it than the budget allows, and where the library that decodes it was not there when
// Tenebra was built.
void decode_meshopt(Asset& asset);  ///< EXT_meshopt_compression, by libmeshoptimizer
void decode_draco(Asset& asset);    ///< KHR_draco_mesh_compression, by libdraco
bool has_meshopt();

/// Adds `bytes` as a buffer of its own and makes `view` all of it.
void set_view(Asset& asset, tinygltf::BufferView& view, std::string bytes);
/// Takes `decoded` bytes from the budget and adds what they allow, as if the file had them uncompressed; no
/// more than 16 times the `stored` bytes count. Throws ImportFailure naming `place`.
void pay_for_decoded(Asset& asset, std::uint64_t stored, std::uint64_t decoded, const std::string& place);

/// Ranges of all views and accessors, declared bounds, finite values. Throws ImportFailure.
void check_accessors(Asset& asset);

/// Values of an accessor as doubles, normalised integers mapped to [0,1] or [-1,1], sparse entries applied:
/// count * components of them (columns of a matrix one after the other).
std::vector<double> read_numbers(Asset& asset, int accessor);
/// Values of an accessor of unsigned integers. `what` names the user.
std::vector<std::uint32_t> read_indices(Asset& asset, int accessor, const std::string& what);
int component_count(const Accessor& accessor);

/// Joints and weights of a primitive's vertices: four of each, and the fifth to eighth where it has them.
/// Empty lists: the primitive has none.
struct Influences {
  std::vector<glm::u16vec4> joints, more_joints;
  std::vector<glm::vec4> weights, more_weights;  ///< their sum is 1
  std::size_t mended = 0;                        ///< vertices whose weights had another sum
  std::size_t repeated = 0;                      ///< vertices that have a joint twice
};
Influences read_influences(Asset& asset, const tinygltf::Primitive& primitive, const std::string& place);
/// The bytes of a data URI. Throws ImportFailure naming `place`.
std::string decode_data_uri(const std::string& uri, const std::string& place);

/// Whether a texture of its material needs coordinates that `primitive` does not have: it shows one colour.
bool lacks_coordinates(const Asset& asset, const tinygltf::Primitive& primitive);
/// Texture coordinates and colours of `primitive`, the last `count` vertices of `mesh`. What cannot be read
/// is a warning.
void add_coordinates(Asset& asset, const tinygltf::Primitive& primitive, const std::string& place,
                     std::size_t count, Mesh& mesh);
/// Gives the vertices of primitives that lack coordinates or colours zeros and white, where others have some.
void even_out_coordinates(Mesh& mesh);

// One table each into asset.scene, in this order.
/// With the pictures that they use, from `folder` or the texture paths.
void build_materials(Asset& asset, const std::filesystem::path& folder, const ImportOptions& options);
/// glTF's material for triangles without one.
Material default_material();
void build_cameras(Asset& asset);
void build_lights(Asset& asset);
void build_meshes(Asset& asset);
/// Makes the scene of that name, else of that number, the one that is shown; empty: the file's default.
void choose_scene(Asset& asset, const std::string& wanted);
/// Nodes of the scene that is shown, parents first. Returns the scene's node of each node of the file, or -1.
/// Throws ImportFailure for a node with several parents.
std::vector<int> build_nodes(Asset& asset);
/// How many instances the file's node `index` has.
std::size_t count_instances(const Asset& asset, int index);
/// Makes room for `count` nodes of instances, in all. Throws ImportFailure where the budget has none.
void reserve_instances(Asset& asset, std::size_t count);
/// EXT_mesh_gpu_instancing of the file's node `index`: its mesh moves from the scene's node `self` to a
/// node below it for each instance.
void add_instances(Asset& asset, int index, int self);
/// Ambient light and background from the shown scene's extras, where it has them.
void build_surroundings(Asset& asset);
void build_skins(Asset& asset, const std::vector<int>& scene_node);
void build_clips(Asset& asset, const std::vector<int>& scene_node);

/// Member `name` of the object `value`, or nullptr.
inline const Value* member(const Value& value, const char* name) {
  return value.IsObject() && value.Has(name) ? &value.Get(name) : nullptr;
}

/// Number `name` of the object `value`, or `otherwise`.
inline double number_or(const Value& value, const char* name, double otherwise) {
  const Value* found = member(value, name);
  return found ? found->GetNumberAsDouble() : otherwise;
}

/// The numbers `name` of the object `value`, as many as `color` has, if they are there.
template <class Color>
void read_color(const Value& value, const char* name, Color& color) {
  const Value* found = member(value, name);
  if (!found) return;
  for (int k = 0; k < color.length(); ++k) color[k] = static_cast<float>(found->Get(k).GetNumberAsDouble());
}

/// Whether the string `name` of the object `value` is `text`.
inline bool says(const Value& value, const char* name, const char* text) {
  const Value* found = member(value, name);
  return found && found->IsString() && found->Get<std::string>() == text;
}

/// Whether `extras.casts_shadow` is false.
inline bool says_no_shadow(const Value& extras) {
  const Value* found = member(extras, "casts_shadow");
  return found && found->IsBool() && !found->Get<bool>();
}

}  // namespace tenebra::formats::gltf
