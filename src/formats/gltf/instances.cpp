// EXT_mesh_gpu_instancing: one node for each instance, below the node that lists them.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

constexpr const char* instancing_name = "EXT_mesh_gpu_instancing";

struct Instances {
  std::string place;
  std::size_t count = 0;
  std::vector<double> translations, rotations, scales;  ///< 3, 4 and 3 for each; empty: all the same
};

std::vector<double> read_attribute(Asset& asset, const Value& attributes, const char* name, int type,
                                   Instances& instances) {
  const Value* found = member(attributes, name);
  if (!found) return {};
  const int index = found->GetNumberAsInt();
  const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(index)];
  const std::string what = instances.place + "." + name;
  const bool rotation = type == TINYGLTF_TYPE_VEC4;
  const bool integers = accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE ||
                        accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT;
  const bool right = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                     (rotation && integers && accessor.normalized);
  if (accessor.type != type || !right)
    refuse("{}: found accessors[{}] of another format, expected {}", what, index,
           rotation ? "VEC4 of floats or normalised signed integers" : "VEC3 of floats");
  if (instances.count != 0 && accessor.count != instances.count)
    refuse("{}: found {} elements, expected the {} of the other attributes", what, accessor.count,
           instances.count);
  instances.count = accessor.count;
  return read_numbers(asset, index);
}

/// The accessor that says how many instances there are; -1: none does.
int counting_accessor(const Value& attributes) {
  for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
    if (const Value* found = member(attributes, name)) return found->GetNumberAsInt();
  const auto names = attributes.Keys();  // the application's own
  return names.empty() ? -1 : attributes.Get(names.front()).GetNumberAsInt();
}

Instances read_instances(Asset& asset, const Value& extension, int index) {
  Instances instances;
  instances.place = fmt::format("nodes[{}].extensions.{}.attributes", index, instancing_name);
  const Value& attributes = extension.Get("attributes");
  instances.translations = read_attribute(asset, attributes, "TRANSLATION", TINYGLTF_TYPE_VEC3, instances);
  instances.rotations = read_attribute(asset, attributes, "ROTATION", TINYGLTF_TYPE_VEC4, instances);
  instances.scales = read_attribute(asset, attributes, "SCALE", TINYGLTF_TYPE_VEC3, instances);
  for (const std::string& name : attributes.Keys()) {
    if (name == "TRANSLATION" || name == "ROTATION" || name == "SCALE" || name.starts_with("_")) continue;
    asset.scene.warnings.push_back(
        fmt::format("{}: found unknown '{}', left unread.", instances.place, name));
  }
  if (const int counting = counting_accessor(attributes); counting >= 0)
    instances.count = asset.model.accessors[static_cast<std::size_t>(counting)].count;
  return instances;
}

Node instance_node(const Instances& instances, std::size_t i, const Node& shown) {
  Node node;
  node.mesh = shown.mesh;
  node.weights = shown.weights;
  const auto vec3 = [i](const std::vector<double>& v) {
    return glm::dvec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
  };
  if (!instances.translations.empty()) node.translation = vec3(instances.translations);
  if (!instances.scales.empty()) node.scale = vec3(instances.scales);
  if (instances.rotations.empty()) return node;
  const double* r = instances.rotations.data() + 4 * i;
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  const double length = glm::length(rotation);
  if (!(length > 0 && std::isfinite(length)))
    refuse("{}.ROTATION: found no direction at {}, expected unit quaternions", instances.place, i);
  node.rotation = rotation / length;
  return node;
}

}  // namespace

std::size_t count_instances(const Asset& asset, int index) {
  const auto& source = asset.model.nodes[static_cast<std::size_t>(index)];
  const auto found = source.extensions.find(instancing_name);
  const int counting =
      found == source.extensions.end() ? -1 : counting_accessor(found->second.Get("attributes"));
  return counting < 0 ? 0 : asset.model.accessors[static_cast<std::size_t>(counting)].count;
}

void reserve_instances(Asset& asset, std::size_t count) {
  // The budget is below half of what import_scene.h promises, as lists double while they grow. Nodes do not,
  // here, and so count half; beside each there are the numbers of its transform, until it is made.
  constexpr std::size_t bytes = (sizeof(Node) + 10 * sizeof(double)) / 2;
  if (!asset.budget.try_take(count, bytes))
    refuse("{}: found {} instances in all, expected at most {}, for a file of this size (split the scene)",
           instancing_name, count, asset.budget.left() / bytes);
  asset.scene.nodes.reserve(asset.scene.nodes.size() + count);
}

void add_instances(Asset& asset, int index, int self) {
  const auto& source = asset.model.nodes[static_cast<std::size_t>(index)];
  const auto found = source.extensions.find(instancing_name);
  if (found == source.extensions.end()) return;
  // reserve_instances() has paid for the numbers, at most ten an instance; readers take 16 bytes for each.
  const Budget before = asset.budget;
  asset.budget.give(std::uint64_t{10 * 16} * count_instances(asset, index));
  const Instances instances = read_instances(asset, found->second, index);
  asset.budget = before;
  Node shown = asset.scene.nodes[static_cast<std::size_t>(self)];
  if (shown.mesh < 0) return;
  if (shown.skin >= 0) {
    asset.scene.warnings.push_back(fmt::format(
        "{}: found on a mesh with a skin, which says where it stands; shown once.", instances.place));
    return;
  }
  auto& nodes = asset.scene.nodes;
  asset.instances[self] = {static_cast<int>(nodes.size()), static_cast<int>(instances.count)};
  for (std::size_t i = 0; i < instances.count; ++i) {
    Node node = instance_node(instances, i, shown);
    node.parent = self;
    nodes.push_back(std::move(node));
  }
  nodes[static_cast<std::size_t>(self)].mesh = -1;
}

}  // namespace tenebra::formats::gltf
