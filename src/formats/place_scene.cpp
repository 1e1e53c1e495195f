#include "formats/place_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "formats/file_points.h"
#include "math/box.h"
#include "math/vertex_rounding.h"
#include "scene/pose.h"
#include "scene/unrounded.h"

namespace tenebra::formats {
namespace {

/// The instant at which the first clip begins; without clips the rest pose.
struct Start {
  int clip = -1;
  double time_s = 0;

  explicit Start(const Scene& scene) {
    if (!scene.clips.empty()) clip = 0, time_s = scene.clips.front().start_s;
  }
};

/// Bounds of the scene's vertices, and some of the vertices.
std::vector<glm::dvec3> places_of_vertices(const Scene& scene, const Start& start) {
  constexpr std::size_t enough = 1 << 16;
  std::size_t count = 0;
  for (const Node& node : scene.nodes)
    if (node.mesh >= 0) count += scene.meshes[static_cast<std::size_t>(node.mesh)].positions.size();
  const std::size_t step = count / enough + 1;
  std::vector<glm::dvec3> places;
  math::Box<double> bounds;
  scene::each_unrounded(scene, start.clip, start.time_s, [&](std::size_t vertex, const glm::dvec3& place) {
    bounds.add(place);
    if (vertex % step == 0) places.push_back(place);
  });
  places.push_back(bounds.low);
  places.push_back(bounds.high);
  return places;
}

FileFrame frame_of(const Placement& placement, const Scene& scene) {
  if (placement.offset != OffsetChoice::automatic) return choose_frame(placement, {}, {});
  const Start start(scene);
  Pose pose;
  scene::evaluate_pose(scene, start.clip, start.time_s, pose);
  std::vector<glm::dvec3> carriers;
  for (const NodePose& node : pose.nodes) carriers.emplace_back(node.to_world[3]);
  return choose_frame(placement, {}, places_of_vertices(scene, start), carriers);
}

/// Keys of a translation, moved. Tangents stay.
Track moved_track(Track track, const glm::dvec3& offset) {
  const bool tangents = track.interpolation == Interpolation::cubic_spline;
  for (std::size_t i = tangents ? 3 : 0; i + 3 <= track.values.size(); i += tangents ? 9 : 3)
    for (int axis = 0; axis < 3; ++axis) track.values[i + static_cast<std::size_t>(axis)] -= offset[axis];
  return track;
}

void move_keys_of_roots(const Scene& scene, const glm::dvec3& offset, Clip& clip) {
  std::map<int, int> moved;  // tracks may be shared with other nodes
  for (Channel& channel : clip.channels) {
    const bool root = scene.nodes[static_cast<std::size_t>(channel.node)].parent < 0;
    if (!root || channel.path != ChannelPath::translation) continue;
    const auto [found, fresh] = moved.try_emplace(channel.track, static_cast<int>(clip.tracks.size()));
    if (fresh)
      clip.tracks.push_back(moved_track(clip.tracks[static_cast<std::size_t>(channel.track)], offset));
    channel.track = found->second;
  }
}

/// By what a unit of `unit` metres changes an intensity: candela by its square, as light falls off with the
/// distance's square.
double intensity_scale(const Light& light, double unit) {
  const bool point = light.type == LightType::point || light.type == LightType::spot;
  return point && light.falloff == Falloff::inverse_square ? unit * unit : 1;
}

/// The same for what a channel drives. Nodes follow from the root above them.
double channel_scale(const Scene& scene, const Channel& channel, double unit) {
  const int light = scene.nodes[static_cast<std::size_t>(channel.node)].light;
  switch (channel.path) {
    case ChannelPath::light_range:
    case ChannelPath::camera_extent:
    case ChannelPath::camera_near:
      return unit;
    case ChannelPath::light_intensity:
      return light < 0 ? 1 : intensity_scale(scene.lights[static_cast<std::size_t>(light)], unit);
    default:
      return 1;
  }
}

void scale_keys(const Scene& scene, double unit, Clip& clip) {
  std::map<std::pair<int, double>, int> scaled;
  for (Channel& channel : clip.channels) {
    const double scale = channel_scale(scene, channel, unit);
    if (scale == 1) continue;
    const auto [found, fresh] =
        scaled.try_emplace({channel.track, scale}, static_cast<int>(clip.tracks.size()));
    if (fresh) {
      Track track = clip.tracks[static_cast<std::size_t>(channel.track)];
      for (double& value : track.values) value *= scale;
      clip.tracks.push_back(std::move(track));
    }
    channel.track = found->second;
  }
}

/// Lengths of cameras and lights, which are in world space: no node scales them.
void scale_lengths(double unit, Scene& scene) {
  for (Camera& camera : scene.cameras) {
    camera.near_m = static_cast<float>(camera.near_m * unit);
    camera.vertical_extent_m = static_cast<float>(camera.vertical_extent_m * unit);
  }
  for (Clip& clip : scene.clips) scale_keys(scene, unit, clip);
  for (Light& light : scene.lights) {
    if (light.range_m) *light.range_m = static_cast<float>(*light.range_m * unit);
    light.intensity = static_cast<float>(light.intensity * intensity_scale(light, unit));
  }
}

void move_roots(const glm::dvec3& offset, Scene& scene) {
  for (Node& node : scene.nodes) {
    if (node.parent >= 0) continue;
    node.translation -= offset;
    if (node.matrix) (*node.matrix)[3] -= glm::dvec4(offset, 0.0);
  }
  for (Clip& clip : scene.clips) move_keys_of_roots(scene, offset, clip);
}

/// Makes `root` the parent of all roots, and node 0.
void hang_from(const Node& root, Scene& scene) {
  for (Node& node : scene.nodes) ++node.parent;
  scene.nodes.insert(scene.nodes.begin(), root);
  for (Skin& skin : scene.skins)
    for (int& joint : skin.joints) ++joint;
  for (Light& light : scene.lights)
    for (int& node : light.left_out_nodes) ++node;
  for (Clip& clip : scene.clips)
    for (Channel& channel : clip.channels) ++channel.node;
}

}  // namespace

void place_scene(const Placement& placement, Scene& scene) {
  scene.frame = frame_of(placement, scene);
  if (scene.frame.origin != glm::dvec3(0)) move_roots(scene.frame.origin, scene);
  if (scene.frame.up == UpAxis::y && scene.frame.metres_per_unit == 1) return;
  if (scene.frame.metres_per_unit != 1) scale_lengths(scene.frame.metres_per_unit, scene);
  Node root;
  root.name = "placement";
  root.matrix = glm::dmat4(0.0);  // exact, unlike the rotation by a quaternion
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = scene.frame.metres_per_unit;
    (*root.matrix)[axis] = glm::dvec4(scene.frame.direction_to_scene(unit), 0.0);
  }
  (*root.matrix)[3] = {0, 0, 0, 1};
  hang_from(root, scene);
}

void warn_of_stored_floats(bool of_places, Scene& scene) {
  if (scene.frame.origin == glm::dvec3(0.0)) return;
  double largest_m = 0;
  const auto add = [&](const glm::dvec3& place, double scale) {
    for (int axis = 0; axis < 3; ++axis) largest_m = std::max(largest_m, scale * std::abs(place[axis]));
  };
  if (of_places) add(scene.frame.origin, scene.frame.metres_per_unit);
  const Start start(scene);
  Pose pose;
  scene::evaluate_pose(scene, start.clip, start.time_s, pose);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const Node& node = scene.nodes[n];
    if (node.mesh < 0 || node.skin >= 0) continue;
    double scale = 0;
    for (int axis = 0; axis < 3; ++axis)
      scale = std::max(scale, glm::length(glm::dvec3(pose.nodes[n].to_world[axis])));
    for (const glm::vec3& place : scene.meshes[static_cast<std::size_t>(node.mesh)].positions)
      add(glm::dvec3(place), scale);
  }
  math::Box<double> bounds;
  scene::each_unrounded(scene, start.clip, start.time_s,
                        [&](std::size_t, const glm::dvec3& place) { bounds.add(place); });
  if (bounds.empty()) return;
  const int side = bounds.longest_side();
  warn_of_floats(largest_m, bounds.high[side] - bounds.low[side], scene);
}

void warn_of_tolerance(Scene& scene) {
  const Start start(scene);
  math::Box<double> bounds;
  scene::each_unrounded(scene, start.clip, start.time_s,
                        [&](std::size_t, const glm::dvec3& place) { bounds.add(place); });
  if (bounds.empty() || !std::isfinite(bounds.diagonal())) return;
  const double tolerance_m = 2 * math::vertex_rounding * bounds.largest_coordinate();  // of two triangles
  const int side = bounds.longest_side();
  if (!(tolerance_m > std::min(1e-3, 1e-3 * (bounds.high[side] - bounds.low[side])))) return;
  scene.warnings.push_back(fmt::format(
      "Coordinates reach {:.0f} m: a surface casts no shadow on points closer than {:.3g} m to its plane, "
      "the tolerance of floats of that size{}.",
      bounds.largest_coordinate(), tolerance_m,
      scene.frame.metres_per_unit == 1 ? " (--unit mm where the file's lengths are millimetres)" : ""));
}

}  // namespace tenebra::formats
