// Nodes of a GLB. glTF has no hidden nodes that every program knows: those that stay hidden lose what they
// hold.
#include <fmt/core.h>
#include <cmath>

#include "formats/glb/writer.h"
#include "math/right_angles.h"

namespace tenebra::formats {

void GlbWriter::find_hidden_nodes() {
  std::size_t hidden = 0;
  std::vector<bool> animated(scene_.nodes.size(), false);
  for (const Clip& clip : scene_.clips)
    for (const Channel& channel : clip.channels)
      if (channel.path == ChannelPath::visibility) animated[static_cast<std::size_t>(channel.node)] = true;
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    const Node& node = scene_.nodes[i];
    const bool by_parent = node.parent >= 0 && hidden_[static_cast<std::size_t>(node.parent)];
    hidden_.push_back(by_parent || (!node.visible && !animated[i]));
    hidden += hidden_.back() && (node.mesh >= 0 || node.light >= 0);
  }
  if (hidden > 0)
    losses.push_back(fmt::format("{} hidden nodes are written without their meshes and lights.", hidden));
}

int GlbWriter::written_mesh(std::size_t node) const {
  const int mesh = scene_.nodes[node].mesh;
  return mesh < 0 || hidden_[node] ? -1 : mesh_of_[static_cast<std::size_t>(mesh)];
}

void GlbWriter::write_transform(std::size_t index, GlbJson& written) {
  const Node& node = scene_.nodes[index];
  if (node.matrix) {
    for (int i = 0; i < 16; ++i) written["matrix"].push_back((*node.matrix)[i / 4][i % 4]);
    if (math::has_right_angles(*node.matrix)) return;  // a product of translation, rotation and scale
    losses.push_back(fmt::format(
        "nodes[{}] '{}': its matrix is no product of translation, rotation and scale; other programs may "
        "refuse it.",
        index, node.name));
    return;
  }
  // Shown later: write_visibility() in the animations does the same.
  const glm::dvec3 scale = node.visible || hidden_[index] ? node.scale : glm::dvec3(0);
  written["translation"] = {node.translation.x, node.translation.y, node.translation.z};
  written["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
  written["scale"] = {scale.x, scale.y, scale.z};
}

void GlbWriter::write_contents(std::size_t index, GlbJson& written) {
  const Node& node = scene_.nodes[index];
  if (const int mesh = written_mesh(index); mesh >= 0) {
    written["mesh"] = mesh;
    if (node.skin >= 0 && skin_of_[static_cast<std::size_t>(node.skin)] >= 0)
      written["skin"] = skin_of_[static_cast<std::size_t>(node.skin)];
    if (!node.weights.empty()) written["weights"] = node.weights;
  }
  if (node.camera >= 0) written["camera"] = node.camera;
  if (node.light < 0 || hidden_[index]) return;
  const auto light = static_cast<std::size_t>(node.light);
  const bool area = scene_.lights[light].type >= LightType::area_rect;
  written["extensions"][area ? "EXT_lights_area" : "KHR_lights_punctual"]["light"] = light_of_[light];
}

void GlbWriter::write_nodes() {
  find_hidden_nodes();
  GlbJson roots = GlbJson::array();
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    GlbJson written = {{"name", scene_.nodes[i].name}};
    write_transform(i, written);
    write_contents(i, written);
    root_["nodes"].push_back(std::move(written));
    const int parent = scene_.nodes[i].parent;
    if (parent >= 0)
      root_["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(i);
    else
      roots.push_back(i);
  }
  if (const FileFrame& frame = scene_.frame; frame.origin != glm::dvec3(0)) {
    const glm::dvec3 origin = frame.direction_to_scene(frame.origin * frame.metres_per_unit);
    root_["nodes"].push_back({{"name", "origin"}, {"translation", {origin.x, origin.y, origin.z}}});
    if (!roots.empty()) root_["nodes"].back()["children"] = roots;
    roots = {scene_.nodes.size()};
  }
  root_["scene"] = 0;
  GlbJson shown = roots.empty() ? GlbJson::object() : GlbJson{{"nodes", roots}};
  shown["extras"] = {{"ambient_light", to_json(scene_.ambient_light)},
                     {"background", to_json(scene_.background)}};
  if (scene_.transfer == Transfer::display) shown["extras"]["transfer"] = "display";
  for (const auto& [name, text] : additions_.notes) shown["extras"][name] = text;
  root_["scenes"].push_back(std::move(shown));
}

}  // namespace tenebra::formats
