// Meshes of a glTF file: the primitives of each become one Mesh, with one material for each triangle.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

struct MeshBuilder {
  Asset& asset;
  std::size_t index;
  Mesh mesh;
  std::size_t non_unit = 0, lines = 0, no_positions = 0, mended_weights = 0, repeated_joints = 0;
  std::size_t without_coordinates = 0, odd_tangents = 0;
  bool ignored_sets = false, any_normals = false, any_joints = false, all_joints = true;

  std::string place(std::size_t primitive) const {
    return fmt::format("meshes[{}].primitives[{}]", index, primitive);
  }

  const Accessor& accessor(int i) const { return asset.model.accessors[static_cast<std::size_t>(i)]; }

  std::vector<double> read(int i, int type, bool integers_allowed, const std::string& what) {
    const Accessor& source = accessor(i);
    if (source.type != type)
      refuse("{}: found accessors[{}] of another type, expected {}", what, i,
             type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "VEC4");
    if (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !integers_allowed)
      asset.scene.warnings.push_back(
          fmt::format("{}: found accessors[{}] of integers, expected floats; read as they are.", what, i));
    return read_numbers(asset, i);
  }

  bool quantized() const {
    const auto& used = asset.model.extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
  }

  std::vector<glm::vec3> read_vec3(int i, const std::string& what) {
    const std::vector<double> numbers = read(i, TINYGLTF_TYPE_VEC3, quantized(), what);
    std::vector<glm::vec3> result(numbers.size() / 3);
    for (std::size_t k = 0; k < result.size(); ++k)
      result[k] = {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
    return result;
  }

  /// `primitive` without attributes that are not needed and do not fit.
  tinygltf::Primitive check_attributes(tinygltf::Primitive primitive, std::size_t p, std::size_t count) {
    const auto does_not_fit = [&](const auto& attribute) {
      const auto& [name, i] = attribute;
      if (name == "NORMAL" && accessor(i).type != TINYGLTF_TYPE_VEC3) {
        asset.scene.warnings.push_back(
            fmt::format("{}.attributes.NORMAL: found accessors[{}] of another type, expected VEC3; left out.",
                        place(p), i));
        return true;
      }
      if (accessor(i).count == count) return false;
      const std::string what = fmt::format("{}.attributes.{}: found {} elements, expected the {} of POSITION",
                                           place(p), name, accessor(i).count, count);
      if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) refuse("{}", what);
      asset.scene.warnings.push_back(what + "; left out.");
      return true;
    };
    std::erase_if(primitive.attributes, does_not_fit);
    for (const auto& [name, i] : primitive.attributes) {
      const bool known = name == "POSITION" || name == "NORMAL" || name == "TANGENT" ||
                         name.starts_with("TEXCOORD_") || name.starts_with("COLOR_") ||
                         name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_") || name.starts_with("_");
      if (!known)
        asset.scene.warnings.push_back(
            fmt::format("{}.attributes: found unknown '{}', left unread.", place(p), name));
      ignored_sets |= name.starts_with("JOINTS_") && name != "JOINTS_0" && name != "JOINTS_1";
    }
    return primitive;
  }

  /// Tangents where a normal map reads them. What is no direction is zero: the coordinates give one then.
  void add_tangents(const tinygltf::Primitive& primitive, std::size_t p, std::size_t count) {
    const auto found = primitive.attributes.find("TANGENT");
    const bool normal = primitive.attributes.contains("NORMAL");
    if (found == primitive.attributes.end() || !normal || primitive.material < 0) return;
    if (!asset.scene.materials[static_cast<std::size_t>(primitive.material)].normal_map) return;
    if (accessor(found->second).type != TINYGLTF_TYPE_VEC4) {
      asset.scene.warnings.push_back(
          fmt::format("{}.attributes.TANGENT: found accessors[{}] of another type, left unread.", place(p),
                      found->second));
      return;
    }
    const std::vector<double> t = read_numbers(asset, found->second);
    mesh.tangents.resize(mesh.positions.size(), glm::vec4(0));
    glm::vec4* out = mesh.tangents.data() + (mesh.tangents.size() - count);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 along(t[4 * i], t[4 * i + 1], t[4 * i + 2]);
      const double length = glm::length(along), side = t[4 * i + 3];
      odd_tangents += !(std::abs(length - 1) <= 2e-2) || std::abs(side) != 1;
      if (length > 0 && std::isfinite(length)) out[i] = {glm::vec3(along / length), side < 0 ? -1.0f : 1.0f};
    }
  }

  void add_normals(const tinygltf::Primitive& primitive, std::size_t p) {
    const auto found = primitive.attributes.find("NORMAL");
    if (found == primitive.attributes.end()) return;
    any_normals = true;
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0));
    std::vector<glm::vec3> normals = read_vec3(found->second, place(p) + ".attributes.NORMAL");
    const std::size_t start = mesh.normals.size() - normals.size();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const float length = glm::length(normals[i]);
      const float slack =
          accessor(found->second).componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ? 5e-3f : 2e-2f;
      non_unit += !(std::abs(length - 1) <= slack);
      mesh.normals[start + i] = std::isfinite(length) && length > 0 ? normals[i] / length : glm::vec3(0);
    }
  }

  void add_joints(const tinygltf::Primitive& primitive, std::size_t p) {
    Influences read = read_influences(asset, primitive, place(p));
    all_joints &= !read.joints.empty();
    if (read.joints.empty()) return;
    any_joints = true;
    mended_weights += read.mended;
    repeated_joints += read.repeated;
    const std::size_t start = mesh.positions.size() - read.joints.size();
    const auto append = [start](auto& list, auto& added, auto zero) {
      if (list.empty() && added.empty()) return;
      list.resize(start, zero);
      list.insert(list.end(), added.begin(), added.end());
    };
    append(mesh.joints, read.joints, glm::u16vec4(0));
    append(mesh.weights, read.weights, glm::vec4(0));
    append(mesh.more_joints, read.more_joints, glm::u16vec4(0));
    append(mesh.more_weights, read.more_weights, glm::vec4(0));
  }

  void add_targets(const tinygltf::Primitive& primitive, std::size_t p, std::size_t count) {
    const auto& first = asset.model.meshes[index].primitives[0].targets;
    if (primitive.targets.size() != first.size())
      refuse("{}.targets: found {}, expected the {} of the first primitive", place(p),
             primitive.targets.size(), first.size());
    mesh.morph_targets.resize(first.size());
    for (std::size_t t = 0; t < first.size(); ++t)
      for (const auto& [name, i] : primitive.targets[t]) {
        const std::string what = fmt::format("{}.targets[{}].{}", place(p), t, name);
        if (accessor(i).count != count)
          refuse("{}: found {} elements, expected the {} of POSITION", what, accessor(i).count, count);
        const bool position = name == "POSITION";
        if (position && (accessor(i).minValues.empty() || accessor(i).maxValues.empty()))
          asset.scene.warnings.push_back(
              fmt::format("{}: found no min and max, which are not needed here.", what));
        MorphTarget& target = mesh.morph_targets[t];
        const bool tangent = name == "TANGENT" && !mesh.tangents.empty();
        if (!position && !tangent && name != "NORMAL") continue;
        auto& list = position ? target.positions : tangent ? target.tangents : target.normals;
        list.resize(mesh.positions.size(), glm::vec3(0));
        const auto values = read_vec3(i, what);
        std::copy(values.begin(), values.end(), list.end() - static_cast<std::ptrdiff_t>(count));
      }
  }

  std::vector<std::uint32_t> corner_list(const tinygltf::Primitive& primitive, std::size_t p,
                                         std::size_t count) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices < 0) {
      corners.resize(count);
      for (std::size_t i = 0; i < count; ++i) corners[i] = static_cast<std::uint32_t>(i);
      return corners;
    }
    const std::string what = place(p) + ".indices";
    corners = read_indices(asset, primitive.indices, what);
    const int type = accessor(primitive.indices).componentType;
    const std::uint32_t restart = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0xFFu
                                  : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xFFFFu
                                                                                   : 0xFFFFFFFFu;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (corners[i] >= count || corners[i] == restart)
        refuse("{}: found index {} at {}, expected less than the {} vertices", what, corners[i], i, count);
    return corners;
  }

  void add_triangles(const std::vector<std::uint32_t>& corners, int mode, std::uint32_t base,
                     std::uint32_t material) {
    const std::size_t n = corners.size();
    const bool list = mode == TINYGLTF_MODE_TRIANGLES;
    const std::size_t triangles = list ? n / 3 : n < 3 ? 0 : n - 2;
    asset.budget.take(triangles, 32, fmt::format("meshes[{}]", index));
    for (std::size_t i = 0; i < triangles; ++i) {
      glm::uvec3 t(corners[list ? 3 * i : i], 0, 0);
      if (list)
        t = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
      else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        t = {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
      else
        t = {corners[i + 1], corners[i + 2], corners[0]};
      mesh.triangles.push_back(t + base);
      mesh.materials.push_back(material);
    }
    if (list ? n % 3 != 0 : n < 3)
      asset.scene.warnings.push_back(fmt::format(
          "meshes[{}]: found {} corners in a primitive of triangles; the left-over ones are ignored.", index,
          n));
  }

  std::uint32_t material_of(const tinygltf::Primitive& primitive) const {
    return static_cast<std::uint32_t>(primitive.material >= 0 ? static_cast<std::size_t>(primitive.material)
                                                              : asset.model.materials.size());
  }

  /// Whether a list of vertices or corners without any, which glTF does not allow, is stated in so many
  /// words.
  bool is_empty(const tinygltf::Primitive& primitive, const Accessor& positions) const {
    if (positions.count == 0 && positions.type == TINYGLTF_TYPE_VEC3) return true;
    if (primitive.indices < 0) return false;
    const Accessor& indices = accessor(primitive.indices);
    return indices.count == 0 && indices.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT;
  }

  void add_primitive(tinygltf::Primitive primitive, std::size_t p) {
    if (primitive.mode < -1 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      asset.scene.warnings.push_back(
          fmt::format("{}.mode: found {}, expected 0 to 6; skipped.", place(p), primitive.mode));
      return;
    }
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end() || is_empty(primitive, accessor(position->second))) {
      ++no_positions;
      return;
    }
    const std::vector<glm::vec3> positions = read_vec3(position->second, place(p) + ".attributes.POSITION");
    primitive = check_attributes(std::move(primitive), p, positions.size());
    const auto corners = corner_list(primitive, p, positions.size());
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      ++lines;
      return;
    }
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
    add_normals(primitive, p);
    add_tangents(primitive, p, positions.size());
    add_coordinates(asset, primitive, place(p), positions.size(), mesh);
    without_coordinates += lacks_coordinates(asset, primitive) ? 1 : 0;
    add_joints(primitive, p);
    add_targets(primitive, p, positions.size());
    add_triangles(corners, mode, base, material_of(primitive));
  }

  // Primitives may differ in their attributes: what one lacks is zero, which stands for the face normal.
  void even_out() {
    const std::size_t count = mesh.positions.size();
    if (any_normals) mesh.normals.resize(count, glm::vec3(0));
    if (!mesh.tangents.empty()) mesh.tangents.resize(count, glm::vec4(0));
    even_out_coordinates(mesh);
    if (any_joints && !all_joints) mesh.joints.clear(), mesh.weights.clear();
    mesh.more_joints.resize(mesh.more_joints.empty() ? 0 : mesh.joints.size(), glm::u16vec4(0));
    mesh.more_weights.resize(mesh.more_joints.size(), glm::vec4(0));
    for (MorphTarget& target : mesh.morph_targets) {
      if (!target.positions.empty()) target.positions.resize(count, glm::vec3(0));
      if (mesh.normals.empty()) target.normals.clear();
      if (!target.normals.empty()) target.normals.resize(count, glm::vec3(0));
      if (!target.tangents.empty()) target.tangents.resize(count, glm::vec3(0));
    }
  }

  void warn() {
    auto& warnings = asset.scene.warnings;
    const std::string here = fmt::format("meshes[{}]", index);
    if (non_unit > 0)
      warnings.push_back(fmt::format("{}: found {} normals not of unit length; made so.", here, non_unit));
    if (odd_tangents > 0)
      warnings.push_back(
          fmt::format("{}: found {} tangents not of unit length or with a sign other than 1 and -1; made so.",
                      here, odd_tangents));
    if (lines > 0)
      warnings.push_back(fmt::format("{}: skipped {} primitives of points or lines.", here, lines));
    if (no_positions > 0)
      warnings.push_back(fmt::format("{}: skipped {} primitives without vertices.", here, no_positions));
    if (mended_weights > 0)
      warnings.push_back(fmt::format("{}: found {} vertices whose skin weights do not sum to 1; made so.",
                                     here, mended_weights));
    if (repeated_joints > 0)
      warnings.push_back(
          fmt::format("{}: found {} vertices with the same joint twice; added up.", here, repeated_joints));
    if (without_coordinates > 0)
      warnings.push_back(
          fmt::format("{}: found {} primitives without the texture coordinates that their materials name.",
                      here, without_coordinates));
    if (ignored_sets)
      warnings.push_back(
          fmt::format("{}: found more than eight joints a vertex; the first eight are used.", here));
  }

  Mesh build() {
    const auto& source = asset.model.meshes[index];
    mesh.name = source.name;
    mesh.casts_shadow = !says_no_shadow(source.extras);
    for (std::size_t p = 0; p < source.primitives.size(); ++p) add_primitive(source.primitives[p], p);
    even_out();
    const std::size_t targets = source.primitives.empty() ? 0 : source.primitives[0].targets.size();
    mesh.morph_targets.resize(targets);
    if (!source.weights.empty() && source.weights.size() != targets)
      refuse("meshes[{}].weights: found {}, expected the {} morph targets", index, source.weights.size(),
             targets);
    mesh.default_weights.assign(source.weights.begin(), source.weights.end());
    mesh.default_weights.resize(targets, 0.0f);
    warn();
    return std::move(mesh);
  }
};

}  // namespace

void build_meshes(Asset& asset) {
  for (std::size_t i = 0; i < asset.model.meshes.size(); ++i) {
    MeshBuilder builder{asset, i, {}};
    asset.scene.meshes.push_back(builder.build());
    asset.scene.meshes.back().source = fmt::format("{}:meshes[{}]", asset.scene.name, i);
  }
  const auto without = static_cast<std::uint32_t>(asset.model.materials.size());
  const auto uses_default = [&](const Mesh& mesh) {
    return std::find(mesh.materials.begin(), mesh.materials.end(), without) != mesh.materials.end();
  };
  if (std::any_of(asset.scene.meshes.begin(), asset.scene.meshes.end(), uses_default)) {
    asset.scene.materials.push_back(default_material());
  }
}

}  // namespace tenebra::formats::gltf
