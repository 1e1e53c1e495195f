// Clips of a GLB. Tracks that glTF knows keep their keys; BART's splines and visibility are baked at frames.
#include <fmt/core.h>
#include <functional>
#include <set>
#include <span>

#include "formats/glb/writer.h"

namespace tenebra::formats {
namespace {

constexpr int most_frames = 10'000'000;  // keys of one baked track

const char* name_of(Interpolation interpolation) {
  if (interpolation == Interpolation::step) return "STEP";
  return interpolation == Interpolation::cubic_spline ? "CUBICSPLINE" : "LINEAR";
}

bool rises(const std::vector<float>& times) {
  return std::is_sorted(times.begin(), times.end(), std::less_equal<>());
}

}  // namespace

/// One animation. Samplers are shared: all nodes of a track, or of a mesh with shapes, have one.
struct GlbWriter::ClipWriter {
  GlbWriter& writer;
  const Clip& clip;
  GlbJson animation = {{"name", clip.name}};
  double delay_s = 0;         ///< added to all times: glTF has none below 0
  std::vector<float> frames;  ///< times in the file of the frames at which values are baked
  int frames_accessor = -1;
  std::map<std::pair<int, ChannelPath>, int> sampler_of_track;
  std::map<int, int> sampler_of_mesh;
  std::set<std::string> pointers;  ///< written already: nodes may share a light
  std::map<std::pair<int, ChannelPath>, const Channel*> channel_of;  ///< by node and path

  const Scene& scene() const { return writer.scene_; }
  const Track& track_of(const Channel& channel) const {
    return clip.tracks[static_cast<std::size_t>(channel.track)];
  }

  std::vector<float> delayed(const std::vector<double>& times_s) const {
    std::vector<float> times;
    times.reserve(times_s.size());
    for (const double time : times_s) times.push_back(static_cast<float>(time + delay_s));
    return times;
  }

  /// Whether the keys of `track` can be written as they are.
  bool keeps_keys(const Track& track) const {
    return track.interpolation != Interpolation::kochanek_bartels && rises(delayed(track.times_s));
  }

  void find_delay() {
    double first = std::min(0.0, clip.start_s);
    for (const Channel& channel : clip.channels)
      if (channel.path != ChannelPath::visibility && keeps_keys(track_of(channel)) &&
          !track_of(channel).times_s.empty())
        first = std::min(first, track_of(channel).times_s.front());
    for (const Mesh& mesh : scene().meshes)
      if (!mesh.shapes.empty()) first = std::min(first, mesh.shapes.front().time_s);
    delay_s = -first;
    if (delay_s > 0)
      writer.losses.push_back(
          fmt::format("clip '{}' starts at {} s: its times are written {} s later, as glTF has none below 0.",
                      clip.name, first, delay_s));
  }

  void find_frames() {
    const int count = frame_count(clip, writer.fps_);
    if (count > most_frames)
      refuse("clip '{}': found {} frames, expected at most {}", clip.name, count, most_frames);
    for (int i = 0; i < count; ++i) {
      const auto time = static_cast<float>(frame_time_s(clip, i, writer.fps_) + delay_s);
      if (frames.empty() || time > frames.back()) frames.push_back(time);
    }
  }

  int frames_input() {
    if (frames.empty()) find_frames();
    if (frames_accessor < 0) frames_accessor = writer.binary_.add_floats(frames, 1, true);
    return frames_accessor;
  }

  int add_sampler(int input, const char* how, const std::vector<float>& values, int components) {
    const int output = writer.binary_.add_floats(values, components, false);
    animation["samplers"].push_back({{"input", input}, {"interpolation", how}, {"output", output}});
    return static_cast<int>(animation["samplers"].size()) - 1;
  }

  void add_channel(int sampler, int node, const char* path) {
    animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
  }

  /// Values at all frames.
  std::vector<double> baked_values(const Track& track, bool rotation) {
    if (frames.empty()) find_frames();
    std::vector<double> values, value(static_cast<std::size_t>(track.components));
    for (const float time : frames) {
      evaluate_track(track, double{time} - delay_s, rotation, value);
      values.insert(values.end(), value.begin(), value.end());
    }
    return values;
  }

  int baked_sampler(const Track& track, ChannelPath path, int components) {
    const int input = frames_input();
    const std::vector<double> numbers = baked_values(track, path == ChannelPath::rotation);
    const std::vector<float> values(numbers.begin(), numbers.end());
    return add_sampler(input, track.interpolation == Interpolation::step ? "STEP" : "LINEAR", values,
                       components);
  }

  int sampler_for(const Channel& channel) {
    const auto [found, fresh] = sampler_of_track.try_emplace({channel.track, channel.path}, -1);
    if (!fresh) return found->second;
    const Track& track = track_of(channel);
    const int components = channel.path == ChannelPath::weights ? 1 : track.components;
    if (!keeps_keys(track)) return found->second = baked_sampler(track, channel.path, components);
    const int input = writer.binary_.add_floats(delayed(track.times_s), 1, true);
    const std::vector<float> values(track.values.begin(), track.values.end());
    return found->second = add_sampler(input, name_of(track.interpolation), values, components);
  }

  const Channel* other(int node, ChannelPath path) const {
    const auto found = channel_of.find({node, path});
    return found == channel_of.end() ? nullptr : found->second;
  }

  void write_channel(const Channel& channel) {
    static constexpr const char* paths[] = {"translation", "rotation", "scale", "weights"};
    const auto node = static_cast<std::size_t>(channel.node);
    if (track_of(channel).times_s.empty()) return;
    if (channel.path == ChannelPath::visibility) return write_visibility(channel);
    if (!drives_node(channel.path)) return write_pointer(channel);
    const bool in_visibility =
        channel.path == ChannelPath::scale && other(channel.node, ChannelPath::visibility);
    const bool without_effect = channel.path == ChannelPath::weights ? writer.written_mesh(node) < 0
                                                                     : scene().nodes[node].matrix.has_value();
    if (in_visibility || without_effect) return;
    add_channel(sampler_for(channel), channel.node, paths[static_cast<int>(channel.path)]);
  }

  /// The JSON pointer to what a channel of a light or camera drives, empty if there is none, and the factor
  /// from the scene's numbers to the file's.
  std::pair<std::string, double> pointer_of(const Channel& channel) const {
    const Node& node = scene().nodes[static_cast<std::size_t>(channel.node)];
    if (channel.path >= ChannelPath::camera_fov) {
      if (node.camera < 0) return {};
      const Camera& camera = scene().cameras[static_cast<std::size_t>(node.camera)];
      const bool perspective = camera.projection == Projection::perspective;
      if (channel.path != ChannelPath::camera_near &&
          perspective != (channel.path == ChannelPath::camera_fov))
        return {};
      const char* name = channel.path == ChannelPath::camera_fov      ? "yfov"
                         : channel.path == ChannelPath::camera_extent ? "ymag"
                                                                      : "znear";
      return {
          fmt::format("/cameras/{}/{}/{}", node.camera, perspective ? "perspective" : "orthographic", name),
          channel.path == ChannelPath::camera_extent ? 0.5 : 1.0};
    }
    if (node.light < 0) return {};
    const auto light = static_cast<std::size_t>(node.light);
    const LightType type = scene().lights[light].type;
    const bool area = type >= LightType::area_rect, spot = type == LightType::spot;
    const std::string place =
        fmt::format("/extensions/{}/lights/{}/", area ? "EXT_lights_area" : "KHR_lights_punctual",
                    writer.light_of_[light]);
    switch (channel.path) {
      case ChannelPath::light_color:
        return {place + "color", writer.color_factor_[light]};
      case ChannelPath::light_intensity:
        return {place + "intensity", writer.intensity_factor_[light]};
      case ChannelPath::light_range:
        return {area ? "" : place + "range", 1};
      case ChannelPath::light_inner_cone:
        return {spot ? place + "spot/innerConeAngle" : "", 1};
      case ChannelPath::light_outer_cone:
        return {spot ? place + "spot/outerConeAngle" : "", 1};
      default:
        return {area ? place + "size" : "", 1};
    }
  }

  /// Keys of a light or camera, for programs that know KHR_animation_pointer.
  void write_pointer(const Channel& channel) {
    const auto [pointer, factor] = pointer_of(channel);
    if (pointer.empty() || !pointers.insert(pointer).second) return;
    const Track& track = track_of(channel);
    const bool keeps = keeps_keys(track);
    const int input = keeps ? writer.binary_.add_floats(delayed(track.times_s), 1, true) : frames_input();
    std::vector<double> numbers = keeps ? track.values : baked_values(track, false);
    std::vector<float> values;
    values.reserve(numbers.size());
    for (const double number : numbers) values.push_back(static_cast<float>(number * factor));
    const char* how = keeps ? name_of(track.interpolation) : "LINEAR";
    const int sampler = add_sampler(input, how, values, track.components);
    animation["channels"].push_back(
        {{"sampler", sampler},
         {"target",
          {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    writer.use("KHR_animation_pointer");
  }

  /// Hidden frames have scale 0; a track of scales of the same node is baked in.
  void write_visibility(const Channel& channel) {
    const Node& node = scene().nodes[static_cast<std::size_t>(channel.node)];
    if (node.matrix) {
      writer.losses.push_back(
          fmt::format("nodes[{}] '{}': it is always shown, as glTF animates no node with a matrix.",
                      channel.node, node.name));
      return;
    }
    const Channel* scaled = other(channel.node, ChannelPath::scale);
    const int input = frames_input();
    std::vector<float> values;
    for (const float time : frames) {
      double visible = 0, s[3] = {node.scale.x, node.scale.y, node.scale.z};
      evaluate_track(track_of(channel), double{time} - delay_s, false, std::span(&visible, 1));
      if (scaled) evaluate_track(track_of(*scaled), double{time} - delay_s, false, s);
      for (const double value : s) values.push_back(visible != 0 ? static_cast<float>(value) : 0.0f);
    }
    add_channel(add_sampler(input, "STEP", values, 3), channel.node, "scale");
  }

  /// Weights that lead from shape to shape: shape k > 0 is target k - 1, shape 0 the base.
  int shapes_sampler(int mesh) {
    const auto [found, fresh] = sampler_of_mesh.try_emplace(mesh, -1);
    if (!fresh) return found->second;
    const auto& shapes = scene().meshes[static_cast<std::size_t>(mesh)].shapes;
    const std::size_t targets = shapes.size() - 1;
    if (targets > GlbBinary::max_bytes / sizeof(float) / shapes.size())
      refuse("{}: found {} key times of animated triangles, expected fewer in a GLB",
             scene().meshes[static_cast<std::size_t>(mesh)].source, shapes.size());
    std::vector<float> times, values;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const auto time = static_cast<float>(shapes[k].time_s + delay_s);
      if (!times.empty() && time <= times.back()) continue;
      times.push_back(time);
      values.resize(values.size() + targets, 0.0f);
      if (k > 0) values[values.size() - targets + k - 1] = 1.0f;
    }
    const int input = writer.binary_.add_floats(times, 1, true);
    return found->second = add_sampler(input, "LINEAR", values, 1);
  }

  void write_shapes() {
    for (std::size_t n = 0; n < scene().nodes.size(); ++n) {
      const int mesh = scene().nodes[n].mesh;
      if (writer.written_mesh(n) < 0 || scene().meshes[static_cast<std::size_t>(mesh)].shapes.size() < 2)
        continue;
      add_channel(shapes_sampler(mesh), static_cast<int>(n), "weights");
    }
  }

  void write() {
    find_delay();
    for (const Channel& channel : clip.channels)
      channel_of.try_emplace({channel.node, channel.path}, &channel);
    for (const Channel& channel : clip.channels) write_channel(channel);
    write_shapes();
    if (animation.contains("channels")) writer.root_["animations"].push_back(std::move(animation));
  }
};

void GlbWriter::write_clips() {
  const std::vector<Clip> shapes_alone(1);
  for (const Clip& clip : scene_.clips.empty() ? shapes_alone : scene_.clips) ClipWriter{*this, clip}.write();
}

}  // namespace tenebra::formats
