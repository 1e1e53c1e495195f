// Lights and cameras of one instant.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <tenebra/frame_geometry.h>
#include "scene/pose.h"
#include "scene/view_basis.h"

namespace tenebra {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Where an orthonormal viewer stands.
struct Viewer {
  glm::dvec3 eye{0.0};
  glm::dmat3 basis{1.0};  ///< right, up, back
};

int positive(int size) {
  return std::max(size, 1);
}

ViewRays perspective_rays(const Viewer& viewer, double vertical_fov_rad, float near_m, int width,
                          int height) {
  constexpr double least = 1e-6;
  const double fov = std::clamp(vertical_fov_rad, least, std::numbers::pi - least);
  const double half_height = std::tan(0.5 * fov);
  const double step = 2.0 * half_height / positive(height);
  const glm::dmat3& b = viewer.basis;
  const glm::dvec3 corner = -b[2] - b[0] * (0.5 * step * positive(width)) + b[1] * half_height;
  return {.eye = glm::vec3(viewer.eye),
          .d0 = glm::vec3(corner),
          .dx = glm::vec3(b[0] * step),
          .dy = glm::vec3(b[1] * -step),
          .near_m = near_m};
}

ViewRays orthographic_rays(const Viewer& viewer, double extent_m, float near_m, int width, int height) {
  const double step = extent_m / positive(height);
  const glm::dmat3& b = viewer.basis;
  const glm::dvec3 corner = viewer.eye - b[0] * (0.5 * step * positive(width)) + b[1] * (0.5 * extent_m);
  return {.eye = glm::vec3(corner),
          .d0 = glm::vec3(-b[2]),
          .dx = glm::vec3(b[0] * step),
          .dy = glm::vec3(b[1] * -step),
          .orthographic = true,
          .near_m = near_m};
}

/// The channels of `clip` that drive lights or cameras; most clips have none.
class PropertyValues {
public:
  PropertyValues(const Scene& scene, int clip, double time_s) : time_s_(time_s) {
    if (clip >= 0 && static_cast<std::size_t>(clip) < scene.clips.size())
      clip_ = &scene.clips[static_cast<std::size_t>(clip)];
  }

  /// Calls set(path, values) for each channel of `node`'s light or camera; values[0] to [2] are there.
  template <class Set>
  void for_each(int node, Set set) const {
    if (clip_ == nullptr) return;
    for (const Channel& channel : clip_->channels) {
      if (drives_node(channel.path) || channel.node != node) continue;
      const Track& track = clip_->tracks[static_cast<std::size_t>(channel.track)];
      std::array<double, 3> values{};
      if (track.components < 1 || track.components > 3 || track.times_s.empty()) continue;
      const std::span<double> written(values.data(), static_cast<std::size_t>(track.components));
      evaluate_track(track, time_s_, false, written);
      set(channel.path, values);
    }
  }

private:
  const Clip* clip_ = nullptr;
  double time_s_;
};

/// Splines overshoot: what may not fall below zero is cut there.
float not_negative(double value) {
  return static_cast<float>(std::max(value, 0.0));
}

void apply_light_value(ChannelPath path, const std::array<double, 3>& v, WorldLight& out, Light& light) {
  const auto angle = [&] { return static_cast<float>(std::clamp(v[0], 0.0, std::numbers::pi / 2)); };
  switch (path) {
    case ChannelPath::light_color:
      out.color = glm::vec3(not_negative(v[0]), not_negative(v[1]), not_negative(v[2]));
      break;
    case ChannelPath::light_intensity:
      out.intensity = not_negative(v[0]);
      break;
    case ChannelPath::light_range:
      if (light.type != LightType::directional) out.range_m = not_negative(v[0]);
      break;
    case ChannelPath::light_inner_cone:
      out.inner_cone_rad = angle();
      break;
    case ChannelPath::light_outer_cone:
      out.outer_cone_rad = angle();
      break;
    case ChannelPath::light_size: {
      const float width = light.size_m.y > 0 ? light.size_m.x / light.size_m.y : 1.0f;
      light.size_m = glm::vec2(width, 1.0f) * not_negative(v[0]);
      break;
    }
    default:
      break;
  }
}

void apply_camera_value(ChannelPath path, double value, Camera& camera) {
  constexpr double least = 1e-6;
  const auto number = static_cast<float>(std::max(value, least));
  if (path == ChannelPath::camera_fov) camera.vertical_fov_rad = number;
  if (path == ChannelPath::camera_extent) camera.vertical_extent_m = number;
  if (path == ChannelPath::camera_near) camera.near_m = number;
}

WorldLight place_light(const Scene& scene, int node, const glm::dmat4& to_world,
                       const PropertyValues& values) {
  WorldLight out{.light = scene.nodes[static_cast<std::size_t>(node)].light, .node = node};
  Light light;
  const Light& source = scene.lights[static_cast<std::size_t>(out.light)];
  light.type = source.type;
  light.size_m = source.size_m;
  values.for_each(node, [&](ChannelPath path, const std::array<double, 3>& v) {
    apply_light_value(path, v, out, light);
  });
  const glm::dmat3 linear(to_world);
  out.position = glm::vec3(to_world[3]);
  out.direction = glm::vec3(-scene::view_basis(-linear[2], linear[1])[2]);
  out.axis_x = glm::vec3(linear[0] * (0.5 * light.size_m.x));
  out.axis_y = glm::vec3(linear[1] * (0.5 * light.size_m.y));
  return out;
}

}  // namespace

std::vector<WorldLight> evaluate_lights(const Scene& scene, int clip, double time_s) {
  Pose pose;
  scene::evaluate_pose(scene, clip, time_s, pose);
  const PropertyValues values(scene, clip, time_s);
  std::vector<WorldLight> lights;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].light < 0 || !pose.nodes[i].visible) continue;
    const WorldLight light = place_light(scene, static_cast<int>(i), pose.nodes[i].to_world, values);
    if (is_finite(light.position) && is_finite(light.axis_x) && is_finite(light.axis_y))
      lights.push_back(light);
  }
  return lights;
}

Light light_at(const Scene& scene, const WorldLight& placed) {
  Light light = scene.lights[static_cast<std::size_t>(placed.light)];
  if (placed.color) light.color = *placed.color;
  if (placed.intensity) light.intensity = *placed.intensity;
  if (placed.range_m) light.range_m = *placed.range_m > 0 ? placed.range_m : std::nullopt;
  if (placed.inner_cone_rad) light.inner_cone_rad = *placed.inner_cone_rad;
  if (placed.outer_cone_rad) light.outer_cone_rad = *placed.outer_cone_rad;
  if (placed.inner_cone_rad || placed.outer_cone_rad)
    light.inner_cone_rad = std::min(light.inner_cone_rad, light.outer_cone_rad);
  return light;
}

ViewRays evaluate_camera(const Scene& scene, int clip, double time_s, int camera, int width, int height) {
  Camera c = scene.cameras[static_cast<std::size_t>(camera)];
  Viewer viewer;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].camera != camera) continue;
    Pose pose;
    scene::evaluate_pose(scene, clip, time_s, pose);
    PropertyValues(scene, clip, time_s)
        .for_each(static_cast<int>(i), [&](ChannelPath path, const std::array<double, 3>& v) {
          apply_camera_value(path, v[0], c);
        });
    const glm::dmat4& to_world = pose.nodes[i].to_world;
    viewer = {glm::dvec3(to_world[3]), scene::view_basis(-glm::dvec3(to_world[2]), glm::dvec3(to_world[1]))};
    break;
  }
  if (c.projection == Projection::orthographic) {
    return orthographic_rays(viewer, c.vertical_extent_m, c.near_m, width, height);
  }
  return perspective_rays(viewer, c.vertical_fov_rad, c.near_m, width, height);
}

ViewRays look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, float vertical_fov_rad, float near_m,
                 int width, int height) {
  const Viewer viewer{glm::dvec3(eye),
                      scene::view_basis(glm::dvec3(target) - glm::dvec3(eye), glm::dvec3(up))};
  return perspective_rays(viewer, vertical_fov_rad, near_m, width, height);
}

}  // namespace tenebra
