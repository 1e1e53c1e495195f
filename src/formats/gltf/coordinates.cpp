// Texture coordinates and colours of a glTF file's vertices.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "formats/gltf/model.h"
#include "scene/material_maps.h"

namespace tenebra::formats::gltf {
namespace {

/// Index of the attribute's accessor if it has a type that glTF allows, else -1 and a warning.
int accessor_of(Asset& asset, const tinygltf::Primitive& primitive, const char* name,
                const std::string& place, std::initializer_list<int> types) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return -1;
  const int type = asset.model.accessors[static_cast<std::size_t>(found->second)].type;
  if (std::find(types.begin(), types.end(), type) != types.end()) return found->second;
  asset.scene.warnings.push_back(fmt::format(
      "{}.attributes.{}: found accessors[{}] of another type, left unread.", place, name, found->second));
  return -1;
}

void add_set(Asset& asset, int accessor, std::size_t count, const Mesh& mesh, std::vector<glm::vec2>& set) {
  const std::vector<double> numbers = read_numbers(asset, accessor);
  set.resize(mesh.positions.size(), glm::vec2(0));
  const auto finite = [](double v) { return std::isfinite(v) ? static_cast<float>(v) : 0.0f; };
  glm::vec2* out = set.data() + (set.size() - count);
  for (std::size_t i = 0; i < count; ++i) out[i] = {finite(numbers[2 * i]), finite(numbers[2 * i + 1])};
}

void add_colors(Asset& asset, int accessor, const std::string& place, std::size_t count, Mesh& mesh) {
  const std::vector<double> numbers = read_numbers(asset, accessor);
  const std::size_t components = numbers.size() / count;
  std::size_t outside = 0;
  mesh.colors.resize(mesh.positions.size(), glm::vec4(1));
  glm::vec4* out = mesh.colors.data() + (mesh.colors.size() - count);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = std::isfinite(numbers[i]) ? std::clamp(numbers[i], 0.0, 1.0) : 1.0;
    outside += value != numbers[i];
    out[i / components][static_cast<int>(i % components)] = static_cast<float>(value);
  }
  if (outside > 0)
    asset.scene.warnings.push_back(
        fmt::format("{}.attributes.COLOR_0: found {} values outside 0 to 1, cut to that.", place, outside));
}

constexpr const char* sets[] = {"TEXCOORD_0", "TEXCOORD_1"};

}  // namespace

bool lacks_coordinates(const Asset& asset, const tinygltf::Primitive& primitive) {
  if (primitive.material < 0) return false;
  const Material& m = asset.scene.materials[static_cast<std::size_t>(primitive.material)];
  const auto maps = scene::texture_maps(m);
  return std::any_of(maps.begin(), maps.end(), [&](const TextureMap* map) {
    return *map && !primitive.attributes.contains(sets[map->uv_set]);
  });
}

void add_coordinates(Asset& asset, const tinygltf::Primitive& primitive, const std::string& place,
                     std::size_t count, Mesh& mesh) {
  if (count == 0) return;
  for (std::size_t s = 0; s < 2; ++s) {
    const int accessor = accessor_of(asset, primitive, sets[s], place, {TINYGLTF_TYPE_VEC2});
    if (accessor >= 0) add_set(asset, accessor, count, mesh, mesh.texture_coordinates[s]);
  }
  const int colors =
      accessor_of(asset, primitive, "COLOR_0", place, {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4});
  if (colors >= 0) add_colors(asset, colors, place, count, mesh);
}

void even_out_coordinates(Mesh& mesh) {
  for (auto& set : mesh.texture_coordinates)
    if (!set.empty()) set.resize(mesh.positions.size(), glm::vec2(0));
  if (!mesh.colors.empty()) mesh.colors.resize(mesh.positions.size(), glm::vec4(1));
}

}  // namespace tenebra::formats::gltf
