// Animations of a glTF file as clips.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "formats/gltf/model.h"
#include "formats/gltf/pointer.h"

namespace tenebra::formats::gltf {
namespace {

/// The scene's nodes that use each mesh, camera and light of the file; a node with weights of its own does
/// not use those of its mesh.
struct NodeUsers {
  std::vector<std::vector<int>> of_mesh, of_camera, of_light;

  NodeUsers(const Asset& asset, const std::vector<int>& scene_node)
      : of_mesh(asset.model.meshes.size()),
        of_camera(asset.model.cameras.size()),
        of_light(asset.scene.lights.size()) {
    const auto add = [](std::vector<std::vector<int>>& lists, int index, int node) {
      if (index >= 0 && node >= 0) lists[static_cast<std::size_t>(index)].push_back(node);
    };
    for (std::size_t n = 0; n < scene_node.size(); ++n) {
      const auto& node = asset.model.nodes[n];
      if (node.weights.empty()) add(of_mesh, node.mesh, scene_node[n]);
      add(of_camera, node.camera, scene_node[n]);
    }
    for (std::size_t n = 0; n < asset.scene.nodes.size(); ++n)
      add(of_light, asset.scene.nodes[n].light, static_cast<int>(n));
  }
};

struct ClipBuilder {
  Asset& asset;
  const std::vector<int>& scene_node;
  const NodeUsers& users;
  std::size_t index;
  Clip clip;
  std::map<std::tuple<int, int, double>, int> track_of;  // sampler, components and factor -> track
  std::set<std::tuple<PointerTable, std::size_t, ChannelPath>> stated;
  std::map<std::pair<int, ChannelPath>, std::size_t> driven;  // nodes of the scene -> channel
  std::size_t aimless = 0, not_unit = 0;
  std::vector<std::string> unread;  // what is driven, but not read

  const tinygltf::Animation& source() const { return asset.model.animations[index]; }

  std::string place(const char* list, std::size_t i) const {
    return fmt::format("animations[{}].{}[{}]", index, list, i);
  }

  const Accessor& accessor(int i) const { return asset.model.accessors[static_cast<std::size_t>(i)]; }

  /// Whether an accessor has no bytes: its zeros are no key times.
  bool is_empty(int i) const { return accessor(i).bufferView < 0 && !accessor(i).sparse.isSparse; }

  std::vector<double> read_times(int input, const std::string& where) {
    if (accessor(input).type != TINYGLTF_TYPE_SCALAR ||
        accessor(input).componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      refuse("{}.input: found accessors[{}] of another format, expected SCALAR floats", where, input);
    if (accessor(input).minValues.empty() || accessor(input).maxValues.empty())
      asset.scene.warnings.push_back(
          fmt::format("{}.input: found no min and max, which are not needed here.", where));
    std::vector<double> times = read_numbers(asset, input);
    if (is_empty(input)) return times;
    clip.end_s = std::max(clip.end_s, times.back());
    double last = -1;
    for (const double time : times) {
      if (!(std::isfinite(time) && time >= 0 && time > last))
        refuse("{}.input: found key time {}, expected rising times from 0 on", where, time);
      last = time;
    }
    return times;
  }

  void check_sampler(std::size_t s) {
    const auto& sampler = source().samplers[s];
    const std::string where = place("samplers", s);
    const std::string& how = sampler.interpolation;
    if (!how.empty() && how != "LINEAR" && how != "STEP" && how != "CUBICSPLINE")
      asset.scene.warnings.push_back(
          fmt::format("{}.interpolation: found '{}', expected LINEAR, STEP or CUBICSPLINE; read as LINEAR.",
                      where, how.substr(0, 40)));
    const std::size_t keys = read_times(sampler.input, where).size();
    if (how == "CUBICSPLINE" && keys < 2)
      refuse("{}.input: found 1 key, expected at least 2 for CUBICSPLINE", where);
  }

  void check_output(const Accessor& output, int components, const PointerTarget& target,
                    const std::string& where) {
    const bool weights = target.path == ChannelPath::weights;
    const bool visibility = target.path == ChannelPath::visibility;
    const bool floats = output.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
    if (!floats && !output.normalized && !visibility)
      refuse("{}.output: found plain integers, expected floats or normalised integers", where);
    const int type = weights || components == 1 ? TINYGLTF_TYPE_SCALAR
                     : components == 3          ? TINYGLTF_TYPE_VEC3
                                                : TINYGLTF_TYPE_VEC4;
    if (output.type != type)
      refuse("{}.output: found another type, expected {}", where,
             type == TINYGLTF_TYPE_SCALAR ? "SCALAR"
             : type == TINYGLTF_TYPE_VEC3 ? "VEC3"
                                          : "VEC4");
  }

  void count_not_unit(const Track& track) {
    const bool cubic = track.interpolation == Interpolation::cubic_spline;
    for (std::size_t i = cubic ? 4 : 0; i + 4 <= track.values.size(); i += cubic ? 12 : 4) {
      const double* q = track.values.data() + i;
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      not_unit += !(std::abs(length - 1) <= 5e-3);
    }
  }

  /// The track of sampler `s` with `components` values per key, in the scene's units.
  int track(int s, int components, const PointerTarget& target) {
    const auto [found, fresh] =
        track_of.try_emplace({s, components, target.factor}, static_cast<int>(clip.tracks.size()));
    const auto& sampler = source().samplers[static_cast<std::size_t>(s)];
    const std::string where = place("samplers", static_cast<std::size_t>(s));
    check_output(accessor(sampler.output), components, target, where);
    if (!fresh) return found->second;
    Track track;
    track.components = components;
    track.interpolation = sampler.interpolation == "STEP"          ? Interpolation::step
                          : sampler.interpolation == "CUBICSPLINE" ? Interpolation::cubic_spline
                                                                   : Interpolation::linear;
    track.times_s = read_numbers(asset, sampler.input);
    const int values_a_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
    track.values = read_numbers(asset, sampler.output);
    const std::size_t expected = track.times_s.size() * static_cast<std::size_t>(components * values_a_key);
    if (track.values.size() != expected)
      refuse("{}.output: found {} numbers, expected {} for its keys", where, track.values.size(), expected);
    if (std::any_of(track.values.begin(), track.values.end(), [](double v) { return !std::isfinite(v); }))
      refuse("{}.output: found a value that is not finite, expected numbers", where);
    if (target.path == ChannelPath::rotation) count_not_unit(track);
    for (double& value : track.values) value *= target.factor;
    clip.tracks.push_back(std::move(track));
    return found->second;
  }

  std::size_t target_count(int node) const {
    const int mesh = asset.model.nodes[static_cast<std::size_t>(node)].mesh;
    return mesh < 0 ? 0 : asset.scene.meshes[static_cast<std::size_t>(mesh)].morph_targets.size();
  }

  /// What the channel drives; nothing where it is not read.
  std::optional<PointerTarget> target_of(const tinygltf::AnimationChannel& channel) {
    static const std::map<std::string, ChannelPath> paths = {{"translation", ChannelPath::translation},
                                                             {"rotation", ChannelPath::rotation},
                                                             {"scale", ChannelPath::scale},
                                                             {"weights", ChannelPath::weights}};
    if (channel.target_path == "pointer") {
      const auto found = channel.target_extensions.find("KHR_animation_pointer");
      const Value* text =
          found == channel.target_extensions.end() ? nullptr : member(found->second, "pointer");
      const std::string pointer = text ? text->Get<std::string>() : "pointer";
      auto target = read_pointer(asset, pointer);
      if (!target) unread.push_back(pointer);
      return target;
    }
    const auto path = paths.find(channel.target_path);
    if (path == paths.end()) {
      unread.push_back(channel.target_path);
      return std::nullopt;
    }
    if (channel.target_node < 0) {
      ++aimless;
      return std::nullopt;
    }
    return PointerTarget{PointerTable::nodes, static_cast<std::size_t>(channel.target_node), path->second};
  }

  void check_node(const PointerTarget& target, const std::string& where) {
    const bool weights = target.path == ChannelPath::weights;
    const int shown = scene_node[target.index];
    if (weights || target.path == ChannelPath::visibility || shown < 0) return;
    if (asset.model.nodes[target.index].matrix.empty()) return;
    const std::string what =
        fmt::format("{}.target: found nodes[{}] that has a matrix, expected translation, rotation and scale",
                    where, target.index);
    if (asset.scene.nodes[static_cast<std::size_t>(shown)].matrix) refuse("{}", what);
    asset.scene.warnings.push_back(what + "; taken apart.");
  }

  std::vector<int> users_of(const PointerTarget& target) const {
    switch (target.table) {
      case PointerTable::meshes:
        return users.of_mesh[target.index];
      case PointerTable::cameras:
        return users.of_camera[target.index];
      case PointerTable::lights:
        return users.of_light[target.index];
      case PointerTable::area_lights:
        return users.of_light[target.index + asset.model.lights.size()];
      default:
        return {scene_node[target.index]};
    }
  }

  /// Nodes of the scene whose property `target` is.
  std::vector<int> nodes_of(const PointerTarget& target) const {
    std::vector<int> nodes;
    for (const int node : users_of(target)) {
      const auto instances = asset.instances.find(node);
      const bool instanced = target.path == ChannelPath::weights && instances != asset.instances.end();
      if (node >= 0 && !instanced) nodes.push_back(node);
      for (int i = 0; instanced && i < instances->second.second; ++i)
        nodes.push_back(instances->second.first + i);
    }
    return nodes;
  }

  int components_of(const PointerTarget& target) const {
    switch (target.path) {
      case ChannelPath::translation:
      case ChannelPath::scale:
      case ChannelPath::light_color:
        return 3;
      case ChannelPath::rotation:
        return 4;
      case ChannelPath::weights:
        return static_cast<int>(target.table == PointerTable::meshes
                                    ? asset.scene.meshes[target.index].morph_targets.size()
                                    : target_count(static_cast<int>(target.index)));
      default:
        return 1;
    }
  }

  void add_channel(std::size_t c) {
    const auto& channel = source().channels[c];
    const std::string where = place("channels", c);
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= source().samplers.size())
      refuse("{}.sampler: found reference {}, expected one of the {} of animations[{}].samplers", where,
             channel.sampler, source().samplers.size(), index);
    const std::optional<PointerTarget> target = target_of(channel);
    if (!target) return;
    const bool of_node = target->table == PointerTable::nodes;
    if (of_node) check_node(*target, where);
    const int components = components_of(*target);
    if (components == 0) {
      asset.scene.warnings.push_back(
          fmt::format("{}.target: found weights of a mesh or node ({}[{}]) without morph "
                      "targets, expected some; skipped.",
                      where, of_node ? "nodes" : "meshes", target->index));
      return;
    }
    if (is_empty(source().samplers[static_cast<std::size_t>(channel.sampler)].input)) {
      ++aimless;
      return;
    }
    const bool again = !stated.insert({target->table, target->index, target->path}).second;
    if (again)
      asset.scene.warnings.push_back(fmt::format(
          "{}.target: found the same property driven twice, expected once; the last counts.", where));
    const int t = track(channel.sampler, components, *target);
    const std::vector<int> nodes = nodes_of(*target);
    asset.budget.take(nodes.size(), 64, where);
    for (const int node : nodes) {
      const auto [known, is_new] = driven.try_emplace({node, target->path}, clip.channels.size());
      if (is_new) clip.channels.push_back({node, target->path, t});
      if (again) clip.channels[known->second].track = t;
    }
  }

  /// All that is driven but not read, by name as far as a sentence goes.
  std::string unread_names() const {
    constexpr std::size_t longest = 2000;
    std::string names;
    for (std::size_t i = 0; i < unread.size(); ++i) {
      if (names.size() > longest) return names + fmt::format(" and {} more", unread.size() - i);
      names += (names.empty() ? "" : ", ") + unread[i].substr(0, 200);
    }
    return names;
  }

  Clip build() {
    clip.name = source().name;
    for (std::size_t s = 0; s < source().samplers.size(); ++s) check_sampler(s);
    for (std::size_t c = 0; c < source().channels.size(); ++c) add_channel(c);
    auto& warnings = asset.scene.warnings;
    if (!unread.empty())
      warnings.push_back(fmt::format("animations[{}]: {} of {} channels drive what is not read: {}.", index,
                                     unread.size(), source().channels.size(), unread_names()));
    if (not_unit > 0)
      warnings.push_back(
          fmt::format("animations[{}]: found {} rotations not of unit length; made so.", index, not_unit));
    if (aimless > 0)
      warnings.push_back(
          fmt::format("animations[{}]: skipped {} channel{} without a node or without key times.", index,
                      aimless, aimless == 1 ? "" : "s"));
    return std::move(clip);
  }
};

}  // namespace

void build_clips(Asset& asset, const std::vector<int>& scene_node) {
  const NodeUsers users(asset, scene_node);
  for (std::size_t i = 0; i < asset.model.animations.size(); ++i) {
    ClipBuilder builder{asset, scene_node, users, i, {}, {}, {}, {}, 0, 0, {}};
    asset.scene.clips.push_back(builder.build());
  }
}

}  // namespace tenebra::formats::gltf
