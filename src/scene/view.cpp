// Lights and cameras of one instant.
#include <algorithm>
#include <cmath>
#include <numbers>

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

WorldLight place_light(const Scene& scene, int node, const glm::dmat4& to_world) {
  WorldLight out{.light = scene.nodes[static_cast<std::size_t>(node)].light, .node = node};
  const Light& light = scene.lights[static_cast<std::size_t>(out.light)];
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
  std::vector<WorldLight> lights;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].light < 0 || !pose.nodes[i].visible) continue;
    const WorldLight light = place_light(scene, static_cast<int>(i), pose.nodes[i].to_world);
    if (is_finite(light.position) && is_finite(light.axis_x) && is_finite(light.axis_y))
      lights.push_back(light);
  }
  return lights;
}

ViewRays evaluate_camera(const Scene& scene, int clip, double time_s, int camera, int width, int height) {
  const Camera& c = scene.cameras[static_cast<std::size_t>(camera)];
  Viewer viewer;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].camera != camera) continue;
    Pose pose;
    scene::evaluate_pose(scene, clip, time_s, pose);
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
