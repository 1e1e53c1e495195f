// Nodes of a glTF file: a strict forest, flattened without recursion.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "formats/gltf/model.h"
#include "formats/gltf/pointer.h"
#include "math/right_angles.h"

namespace tenebra::formats::gltf {
namespace {

/// The nodes that are shown, parents first.
struct ShownNodes {
  std::vector<int> order;
  std::vector<bool> bare;  ///< for each node of the file: it is there for its transform alone
};

/// Depth-first from `roots`, parents before children; nodes on a cycle are never reached from a root.
std::vector<int> order_from(const Model& model, const std::vector<int>& roots) {
  std::vector<int> order, stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    order.push_back(node);
    const auto& children = model.nodes[static_cast<std::size_t>(node)].children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return order;
}

/// The nodes of `listed` that are under no other of them. `order`: all nodes, parents first.
std::vector<int> topmost(const std::vector<int>& parents, const std::vector<int>& order,
                         const std::vector<int>& listed) {
  std::vector<bool> is_listed(parents.size(), false), is_under(parents.size(), false);
  for (const int node : listed) is_listed[static_cast<std::size_t>(node)] = true;
  for (const int node : order) {
    const int parent = parents[static_cast<std::size_t>(node)];
    is_under[static_cast<std::size_t>(node)] = parent >= 0 && (is_listed[static_cast<std::size_t>(parent)] ||
                                                               is_under[static_cast<std::size_t>(parent)]);
  }
  std::vector<int> tops;
  for (const int node : listed)
    if (!is_under[static_cast<std::size_t>(node)]) tops.push_back(node);
  return tops;
}

std::vector<int> find_roots(const std::vector<int>& parents) {
  std::vector<int> roots;
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (parents[i] < 0) roots.push_back(static_cast<int>(i));
  return roots;
}

/// All nodes, parents first; refuses those that no root reaches.
std::vector<int> order_of_all(const Model& model, const std::vector<int>& roots) {
  std::vector<int> order = order_from(model, roots);
  std::vector<bool> reached(model.nodes.size(), false);
  for (const int node : order) reached[static_cast<std::size_t>(node)] = true;
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost != reached.end())
    refuse("nodes[{}]: found it in or below a loop of children, expected every node to hang from a root",
           lost - reached.begin());
  return order;
}

/// Once for each scene: a file may list all its nodes.
void warn_of_children(Asset& asset) {
  for (std::size_t s = 0; s < asset.model.scenes.size(); ++s) {
    std::size_t count = 0;
    int first = -1;
    for (const int node : asset.model.scenes[s].nodes)
      if (asset.parents[static_cast<std::size_t>(node)] >= 0 && count++ == 0) first = node;
    if (count > 0)
      asset.scene.warnings.push_back(
          fmt::format("scenes[{}].nodes: found node {} which is a child{}, expected root nodes; shown once, "
                      "under its parent.",
                      s, first, count > 1 ? fmt::format(", and {} more", count - 1) : ""));
  }
}

/// What the scene that is shown lists; without scenes `roots`.
std::vector<int> listed_nodes(Asset& asset, const std::vector<int>& roots) {
  const Model& model = asset.model;
  warn_of_children(asset);
  auto& warnings = asset.scene.warnings;
  if (model.scenes.empty()) {
    if (!roots.empty()) warnings.push_back("The file has no scenes: all root nodes are shown.");
    return roots;
  }
  if (asset.scene_chosen) return model.scenes[static_cast<std::size_t>(model.defaultScene)].nodes;
  if (model.defaultScene < 0) warnings.push_back("The file names no default scene: the first is shown.");
  if (model.scenes.size() > 1)
    warnings.push_back(fmt::format("The file has {} scenes: number {} is shown, --scene shows another.",
                                   model.scenes.size(), std::max(model.defaultScene, 0)));
  return model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes;
}

/// Appends `node` and its ancestors as bare nodes, as far as they are not there yet.
void add_bare(const std::vector<int>& parents, int node, std::vector<bool>& known, ShownNodes& shown) {
  std::vector<int> chain;
  for (; node >= 0 && !known[static_cast<std::size_t>(node)]; node = parents[static_cast<std::size_t>(node)])
    chain.push_back(node);
  for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
    known[static_cast<std::size_t>(*at)] = shown.bare[static_cast<std::size_t>(*at)] = true;
    shown.order.push_back(*at);
  }
}

/// All below the nodes that the scene lists, each once, where its tree puts it. What the scene does not list
/// but the place of these, or of the joints of a skin, depends on is there without what it shows.
ShownNodes shown_nodes(const Model& model, const std::vector<int>& parents, const std::vector<int>& order,
                       const std::vector<int>& listed) {
  const std::vector<int> full = order_from(model, topmost(parents, order, listed));
  ShownNodes shown{{}, std::vector<bool>(model.nodes.size(), false)};
  std::vector<bool> known(model.nodes.size(), false);
  for (const int node : full) known[static_cast<std::size_t>(node)] = true;
  for (const int node : listed) add_bare(parents, parents[static_cast<std::size_t>(node)], known, shown);
  shown.order.insert(shown.order.end(), full.begin(), full.end());
  for (const int node : full) {
    const int skin = model.nodes[static_cast<std::size_t>(node)].skin;
    if (skin < 0) continue;
    for (const int joint : model.skins[static_cast<std::size_t>(skin)].joints)
      add_bare(parents, joint, known, shown);
  }
  return shown;
}

glm::dmat4 to_matrix(const std::vector<double>& m) {
  glm::dmat4 result;
  for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
  return result;
}

/// Splits a matrix into translation, rotation and scale where its columns are at right angles.
bool decompose(const glm::dmat4& m, Node& node) {
  glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  glm::dvec3 scale(glm::length(x), glm::length(y), glm::length(z));
  if (std::min({scale.x, scale.y, scale.z}) <= 0 || !math::has_right_angles(m)) return false;
  if (glm::dot(glm::cross(x, y), z) < 0) scale.x = -scale.x;
  node.translation = glm::dvec3(m[3]);
  node.rotation = glm::normalize(glm::quat_cast(glm::dmat3(x / scale.x, y / scale.y, z / scale.z)));
  node.scale = scale;
  return true;
}

void set_matrix(Asset& asset, const tinygltf::Node& source, int index, Node& node) {
  const auto& m = source.matrix;
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    refuse("nodes[{}].matrix: found a last row that is not 0 0 0 1, expected an affine matrix", index);
  node.matrix = to_matrix(m);
  // A rotation is rounded: a matrix that nothing moves stays as it is written.
  if (decompose(*node.matrix, node)) {
    if (asset.animated[static_cast<std::size_t>(index)]) node.matrix.reset();
  } else {
    asset.scene.warnings.push_back(fmt::format(
        "nodes[{}].matrix: found no product of translation, rotation and scale; used as it stands.", index));
  }
}

void set_transform(Asset& asset, const tinygltf::Node& source, int index, Node& node) {
  if (!source.matrix.empty()) return set_matrix(asset, source, index, node);
  const auto vec3 = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  if (!source.translation.empty()) node.translation = vec3(source.translation);
  if (!source.scale.empty()) node.scale = vec3(source.scale);
  if (source.rotation.empty()) return;
  const auto& r = source.rotation;
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  const double length = glm::length(rotation);
  if (length == 0) refuse("nodes[{}].rotation: found zeros, expected a unit quaternion", index);
  if (std::abs(length - 1) > 5e-3)
    asset.scene.warnings.push_back(
        fmt::format("nodes[{}].rotation: found length {}; made 1.", index, length));
  node.rotation = rotation / length;
}

void set_mesh(Asset& asset, const tinygltf::Node& source, int index, Node& node) {
  node.mesh = source.mesh;
  node.skin = source.skin;
  if (source.skin >= 0 && source.mesh < 0) {
    asset.scene.warnings.push_back(
        fmt::format("nodes[{}].skin: found no mesh beside it, expected one.", index));
    node.skin = -1;
  }
  if (node.skin >= 0 && asset.scene.meshes[static_cast<std::size_t>(source.mesh)].joints.empty() &&
      !asset.scene.meshes[static_cast<std::size_t>(source.mesh)].triangles.empty())
    refuse("nodes[{}].skin: found a mesh without JOINTS_0 in all primitives, expected them", index);
  if (source.weights.empty()) return;
  const std::size_t targets =
      source.mesh < 0 ? 0 : asset.scene.meshes[static_cast<std::size_t>(source.mesh)].morph_targets.size();
  if (source.weights.size() != targets)
    refuse("nodes[{}].weights: found {}, expected the {} morph targets of its mesh", index,
           source.weights.size(), targets);
  node.weights.assign(source.weights.begin(), source.weights.end());
}

/// Lights of a node: punctual ones come first in Scene::lights, area lights after them.
std::vector<int> lights_of(const Asset& asset, const tinygltf::Node& source, int index) {
  std::vector<int> lights;
  const std::size_t punctual = asset.model.lights.size();
  const auto add = [&](const char* extension, std::size_t first, std::size_t count) {
    const auto found = source.extensions.find(extension);
    if (found == source.extensions.end()) return;
    const double light = number_or(found->second, "light", 0);
    if (!(light < static_cast<double>(count)))
      refuse("nodes[{}].extensions.{}.light: found reference {}, expected one of the {} lights", index,
             extension, light, count);
    lights.push_back(static_cast<int>(first + static_cast<std::size_t>(light)));
  };
  add("KHR_lights_punctual", 0, punctual);
  add("EXT_lights_area", punctual, asset.scene.lights.size() - punctual);
  return lights;
}

Node read_node(Asset& asset, int index) {
  const auto& source = asset.model.nodes[static_cast<std::size_t>(index)];
  Node node;
  node.name = source.name;
  set_transform(asset, source, index, node);
  set_mesh(asset, source, index, node);
  node.camera = source.camera;
  const auto visibility = source.extensions.find("KHR_node_visibility");
  if (visibility != source.extensions.end())
    if (const Value* visible = member(visibility->second, "visible")) node.visible = visible->Get<bool>();
  return node;
}

/// `extras.casts_shadow: false` on a node goes to a copy of its mesh, shared by all nodes that say so.
void leave_out(Asset& asset, Node& node, std::vector<int>& silent_mesh) {
  if (node.mesh < 0) return;
  int& copy = silent_mesh[static_cast<std::size_t>(node.mesh)];
  auto& meshes = asset.scene.meshes;
  if (copy < 0) {
    copy = static_cast<int>(meshes.size());
    const Mesh& mesh = meshes[static_cast<std::size_t>(node.mesh)];
    asset.budget.take(mesh.positions.size() * (1 + mesh.morph_targets.size()) + mesh.triangles.size(), 48,
                      mesh.source);
    meshes.push_back(Mesh(mesh));
    meshes.back().casts_shadow = false;
  }
  node.mesh = copy;
}

void note_animated(Asset& asset) {
  asset.animated.assign(asset.model.nodes.size(), false);
  for (const auto& animation : asset.model.animations)
    for (const auto& channel : animation.channels) {
      if (channel.target_node >= 0) asset.animated[static_cast<std::size_t>(channel.target_node)] = true;
      const auto found = channel.target_extensions.find("KHR_animation_pointer");
      const Value* pointer =
          found == channel.target_extensions.end() ? nullptr : member(found->second, "pointer");
      const auto read = pointer == nullptr ? std::nullopt : read_pointer(asset, pointer->Get<std::string>());
      if (read && read->table == PointerTable::nodes) asset.animated[read->index] = true;
    }
}

void add_all_instances(Asset& asset, const ShownNodes& shown, const std::vector<int>& scene_node) {
  std::vector<int> in_scene;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene_node.size(); ++i) {
    if (scene_node[i] < 0 || shown.bare[i]) continue;
    in_scene.push_back(static_cast<int>(i));
    count += asset.model.nodes[i].mesh < 0 ? 0 : count_instances(asset, in_scene.back());
  }
  if (count > 0) reserve_instances(asset, count);
  for (const int i : in_scene) add_instances(asset, i, scene_node[static_cast<std::size_t>(i)]);
}

/// A mesh can stand at any number of nodes: the size of the frame that is made of them must be limited.
void check_size(const Scene& scene) {
  constexpr std::size_t most = 50'000'000;
  std::size_t triangles = 0, vertices = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    triangles += scene.meshes[static_cast<std::size_t>(node.mesh)].triangles.size();
    vertices += scene.meshes[static_cast<std::size_t>(node.mesh)].positions.size();
  }
  if (triangles > most || vertices > most)
    refuse("nodes: found {} triangles and {} vertices, instances counted, expected at most {} of each",
           triangles, vertices, most);
}

/// The parent of each node, or -1. Refuses a node with several.
std::vector<int> find_parents(const Model& model) {
  std::vector<int> parents(model.nodes.size(), -1);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (const int child : model.nodes[i].children) {
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0)
        refuse("nodes[{}].children: found node {} with parent {} already, expected one parent", i, child,
               parent);
      parent = static_cast<int>(i);
    }
  return parents;
}

}  // namespace

std::vector<int> build_nodes(Asset& asset) {
  const Model& model = asset.model;
  const std::vector<int>& parents = asset.parents = find_parents(model);
  note_animated(asset);
  const std::vector<int> roots = find_roots(parents), order = order_of_all(model, roots);
  const ShownNodes shown = shown_nodes(model, parents, order, listed_nodes(asset, roots));
  std::vector<int> scene_node(model.nodes.size(), -1);
  std::vector<int> silent_mesh(asset.scene.meshes.size(), -1);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {  // nodes that are not shown must be right too
    Node checked = read_node(asset, static_cast<int>(i));
    lights_of(asset, model.nodes[i], static_cast<int>(i));
  }
  const std::size_t warned = asset.scene.warnings.size();
  for (const int index : shown.order) {
    Node node = read_node(asset, index);
    const bool bare = shown.bare[static_cast<std::size_t>(index)];
    if (bare) node.mesh = node.skin = node.camera = -1, node.weights.clear();
    const auto& source = model.nodes[static_cast<std::size_t>(index)];
    const int parent = parents[static_cast<std::size_t>(index)];
    node.parent = parent < 0 ? -1 : scene_node[static_cast<std::size_t>(parent)];
    if (says_no_shadow(source.extras)) leave_out(asset, node, silent_mesh);
    const std::vector<int> lights = bare ? std::vector<int>() : lights_of(asset, source, index);
    if (!lights.empty()) node.light = lights[0];
    const int self = static_cast<int>(asset.scene.nodes.size());
    scene_node[static_cast<std::size_t>(index)] = self;
    asset.scene.nodes.push_back(std::move(node));
    if (lights.size() > 1) {
      Node second;
      second.parent = self;
      second.light = lights[1];
      asset.scene.nodes.push_back(std::move(second));
    }
  }
  asset.scene.warnings.resize(warned);  // the first reading has said it
  add_all_instances(asset, shown, scene_node);
  check_size(asset.scene);
  return scene_node;
}

void choose_scene(Asset& asset, const std::string& wanted) {
  if (wanted.empty()) return;
  const auto& scenes = asset.model.scenes;
  std::string list;
  std::size_t chosen = scenes.size();
  for (std::size_t i = scenes.size(); i-- > 0;) {
    list = fmt::format("{} '{}'{}{}", i, scenes[i].name, list.empty() ? "" : ", ", list);
    if (wanted == std::to_string(i)) chosen = i;
  }
  for (std::size_t i = scenes.size(); i-- > 0;)
    if (scenes[i].name == wanted) chosen = i;
  constexpr std::size_t longest = 400;
  if (list.size() > longest) list = list.substr(0, longest) + "...";
  if (chosen == scenes.size())
    refuse("scenes: found none called or numbered '{}', expected {}", wanted,
           scenes.empty() ? "no choice, as the file has none" : "one of " + list);
  asset.model.defaultScene = static_cast<int>(chosen);
  asset.scene_chosen = true;
}

}  // namespace tenebra::formats::gltf
