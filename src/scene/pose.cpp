#include "scene/pose.h"

#include <algorithm>

#include <tenebra/scene.h>

namespace tenebra::scene {
namespace {

std::size_t morph_target_count(const Scene& scene, const Node& node) {
  return node.mesh < 0 ? 0 : scene.meshes[static_cast<std::size_t>(node.mesh)].morph_targets.size();
}

void start_from_rest(const Scene& scene, Pose& out) {
  out.nodes.resize(scene.nodes.size());
  out.weights.clear();
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    out.nodes[i] = {.translation = node.translation,
                    .rotation = node.rotation,
                    .scale = node.scale,
                    .visible = node.visible,
                    .first_weight = out.weights.size()};
    const std::size_t count = morph_target_count(scene, node);
    if (count == 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const std::vector<float>& rest = node.weights.empty() ? mesh.default_weights : node.weights;
    for (std::size_t k = 0; k < count; ++k) out.weights.push_back(k < rest.size() ? double{rest[k]} : 0.0);
  }
}

void apply_channel(const Scene& scene, const Channel& channel, const Track& track, double time_s, Pose& out) {
  const auto index = static_cast<std::size_t>(channel.node);
  NodePose& node = out.nodes[index];
  std::vector<double>& v = out.track_values;
  v.assign(static_cast<std::size_t>(std::max(track.components, 4)), 0.0);
  const std::span<double> values(v.data(), static_cast<std::size_t>(track.components));
  evaluate_track(track, time_s, channel.path == ChannelPath::rotation, values);
  switch (channel.path) {
    case ChannelPath::translation:
      node.translation = {v[0], v[1], v[2]};
      break;
    case ChannelPath::rotation:
      node.rotation = {v[3], v[0], v[1], v[2]};
      break;
    case ChannelPath::scale:
      node.scale = {v[0], v[1], v[2]};
      break;
    case ChannelPath::visibility:
      node.visible = v[0] != 0.0;
      break;
    case ChannelPath::weights: {
      const std::size_t count = std::min(values.size(), morph_target_count(scene, scene.nodes[index]));
      std::copy_n(v.begin(), count, out.weights.begin() + static_cast<std::ptrdiff_t>(node.first_weight));
      break;
    }
    default:
      break;  // of a light or camera: view.cpp
  }
}

glm::dmat4 local_matrix(const Node& node, const NodePose& pose) {
  if (node.matrix) return *node.matrix;
  const double length = glm::length(pose.rotation);
  const glm::dmat3 rotation = length > 0.0 ? glm::mat3_cast(pose.rotation / length) : glm::dmat3(1.0);
  return {glm::dvec4(rotation[0] * pose.scale.x, 0.0), glm::dvec4(rotation[1] * pose.scale.y, 0.0),
          glm::dvec4(rotation[2] * pose.scale.z, 0.0), glm::dvec4(pose.translation, 1.0)};
}

}  // namespace

void evaluate_pose(const Scene& scene, int clip, double time_s, Pose& out) {
  start_from_rest(scene, out);
  if (clip >= 0 && static_cast<std::size_t>(clip) < scene.clips.size()) {
    const Clip& animation = scene.clips[static_cast<std::size_t>(clip)];
    for (const Channel& channel : animation.channels) {
      if (!drives_node(channel.path)) continue;
      apply_channel(scene, channel, animation.tracks[static_cast<std::size_t>(channel.track)], time_s, out);
    }
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {  // parents come before their children
    NodePose& pose = out.nodes[i];
    pose.to_world = local_matrix(scene.nodes[i], pose);
    if (scene.nodes[i].parent < 0) continue;
    const NodePose& parent = out.nodes[static_cast<std::size_t>(scene.nodes[i].parent)];
    pose.to_world = parent.to_world * pose.to_world;
    pose.visible = pose.visible && parent.visible;
  }
}

}  // namespace tenebra::scene
