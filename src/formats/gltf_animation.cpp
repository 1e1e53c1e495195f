// Animations of a glTF file as clips.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "formats/gltf_model.h"

namespace tenebra::formats::gltf {
namespace {

struct ClipBuilder {
  Asset& asset;
  const std::vector<int>& scene_node;
  std::size_t index;
  Clip clip;
  std::map<std::pair<int, int>, int> track_of;  // sampler and components -> track
  std::set<std::pair<int, int>> driven;         // node and path
  std::size_t pointers = 0, aimless = 0;

  const tinygltf::Animation& source() const { return asset.model.animations[index]; }

  std::string place(const char* list, std::size_t i) const {
    return fmt::format("animations[{}].{}[{}]", index, list, i);
  }

  const Accessor& accessor(int i) const { return asset.model.accessors[static_cast<std::size_t>(i)]; }

  /// An accessor without bytes: its zeros are no key times.
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
      refuse("{}.interpolation: found '{}', expected LINEAR, STEP or CUBICSPLINE", where, how);
    const std::size_t keys = read_times(sampler.input, where).size();
    if (how == "CUBICSPLINE" && keys < 2)
      refuse("{}.input: found 1 key, expected at least 2 for CUBICSPLINE", where);
  }

  /// The track of sampler `s` with `components` values per key.
  int track(int s, int components) {
    const auto [found, fresh] = track_of.try_emplace({s, components}, static_cast<int>(clip.tracks.size()));
    if (!fresh) return found->second;
    const auto& sampler = source().samplers[static_cast<std::size_t>(s)];
    const std::string where = place("samplers", static_cast<std::size_t>(s));
    Track track;
    track.components = components;
    track.interpolation = sampler.interpolation == "STEP"          ? Interpolation::step
                          : sampler.interpolation == "CUBICSPLINE" ? Interpolation::cubic_spline
                                                                   : Interpolation::linear;
    track.times_s = read_numbers(asset, sampler.input);
    const int values_a_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const int type = components == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC4;
    const bool scalar = accessor(sampler.output).type == TINYGLTF_TYPE_SCALAR;
    const Accessor& output = accessor(sampler.output);
    if (output.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !output.normalized)
      refuse("{}.output: found plain integers, expected floats or normalised integers", where);
    track.values = read_numbers(asset, sampler.output);
    if (!scalar && output.type != type)
      refuse("{}.output: found another type, expected {} values", where, components);
    const std::size_t expected = track.times_s.size() * static_cast<std::size_t>(components * values_a_key);
    if (track.values.size() != expected)
      refuse("{}.output: found {} numbers, expected {} for its keys", where, track.values.size(), expected);
    if (std::any_of(track.values.begin(), track.values.end(), [](double v) { return !std::isfinite(v); }))
      refuse("{}.output: found a value that is not finite, expected numbers", where);
    clip.tracks.push_back(std::move(track));
    return found->second;
  }

  std::size_t target_count(int node) const {
    const int mesh = asset.model.nodes[static_cast<std::size_t>(node)].mesh;
    return mesh < 0 ? 0 : asset.scene.meshes[static_cast<std::size_t>(mesh)].morph_targets.size();
  }

  void add_channel(std::size_t c) {
    const auto& channel = source().channels[c];
    const std::string where = place("channels", c);
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= source().samplers.size())
      refuse("{}.sampler: found reference {}, expected one of the {} samplers", where, channel.sampler,
             source().samplers.size());
    static const std::map<std::string, ChannelPath> paths = {{"translation", ChannelPath::translation},
                                                             {"rotation", ChannelPath::rotation},
                                                             {"scale", ChannelPath::scale},
                                                             {"weights", ChannelPath::weights}};
    const auto path = paths.find(channel.target_path);
    if (path == paths.end()) {
      ++pointers;
      return;
    }
    const bool weights = path->second == ChannelPath::weights;
    if (weights && channel.target_node >= 0 && target_count(channel.target_node) == 0)
      refuse("{}.target: found weights of nodes[{}] without morph targets, expected some", where,
             channel.target_node);
    if (channel.target_node < 0 ||
        is_empty(source().samplers[static_cast<std::size_t>(channel.sampler)].input)) {
      ++aimless;
      return;
    }
    const auto& node = asset.model.nodes[static_cast<std::size_t>(channel.target_node)];
    if (!weights && !node.matrix.empty())
      refuse("{}.target: found nodes[{}] that has a matrix, expected translation, rotation and scale", where,
             channel.target_node);
    if (!driven.insert({channel.target_node, static_cast<int>(path->second)}).second)
      refuse("{}.target: found {} of nodes[{}] driven twice, expected once", where, path->first,
             channel.target_node);
    const std::size_t components = weights                                 ? target_count(channel.target_node)
                                   : path->second == ChannelPath::rotation ? 4
                                                                           : 3;
    const int scene = scene_node[static_cast<std::size_t>(channel.target_node)];
    const int t = track(channel.sampler, static_cast<int>(components));
    if (!weights && asset.model
                            .accessors[static_cast<std::size_t>(
                                source().samplers[static_cast<std::size_t>(channel.sampler)].output)]
                            .type == TINYGLTF_TYPE_SCALAR)
      refuse("{}: found SCALAR output, expected VEC3 or VEC4 for {}", where, path->first);
    if (scene >= 0) clip.channels.push_back({scene, path->second, t});
  }

  Clip build() {
    clip.name = source().name;
    for (std::size_t s = 0; s < source().samplers.size(); ++s) check_sampler(s);
    for (std::size_t c = 0; c < source().channels.size(); ++c) add_channel(c);
    auto& warnings = asset.scene.warnings;
    if (pointers > 0)
      warnings.push_back(fmt::format(
          "animations[{}]: skipped {} channels that drive other things than nodes (KHR_animation_pointer).",
          index, pointers));
    if (aimless > 0)
      warnings.push_back(fmt::format(
          "animations[{}]: skipped {} channels without a node or without key times.", index, aimless));
    return std::move(clip);
  }
};

}  // namespace

void build_clips(Asset& asset, const std::vector<int>& scene_node) {
  for (std::size_t i = 0; i < asset.model.animations.size(); ++i) {
    ClipBuilder builder{asset, scene_node, i, {}, {}, {}};
    asset.scene.clips.push_back(builder.build());
  }
}

}  // namespace tenebra::formats::gltf
