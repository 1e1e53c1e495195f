// What is added to a scene that lacks a camera or a light, and what is taken out of its casters.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include <tenebra/frame_geometry.h>
#include "scene/view_basis.h"

namespace tenebra {
namespace {

struct Sphere {
  glm::dvec3 center{0.0};
  double radius = 1.0;
};

int first_clip(const Scene& scene) {
  return scene.clips.empty() ? -1 : 0;
}
double first_time_s(const Scene& scene) {
  return scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
}

void extend(const FrameGeometry& frame, glm::dvec3& low, glm::dvec3& high) {
  for (const glm::uvec3& triangle : frame.triangles) {
    if (triangle == glm::uvec3(0)) continue;
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, glm::dvec3(frame.positions[triangle[k]]));
      high = glm::max(high, glm::dvec3(frame.positions[triangle[k]]));
    }
  }
}

/// A sphere about all triangles at nine times spread over the first clip; the unit sphere if there are none.
Sphere bounding_sphere(const Scene& scene) {
  constexpr int intervals = 8;
  const double start_s = first_time_s(scene);
  const double length_s = scene.clips.empty() ? 0.0 : scene.clips.front().end_s - start_s;
  FrameGeometry frame;
  glm::dvec3 low(INFINITY);
  glm::dvec3 high(-INFINITY);
  for (int i = 0; i <= (length_s > 0 ? intervals : 0); ++i) {
    evaluate_frame(scene, first_clip(scene), start_s + length_s * i / intervals, frame);
    extend(frame, low, high);
  }
  if (!(low.x <= high.x)) return {};
  const double radius = 0.5 * glm::length(high - low);
  return {0.5 * (low + high), radius > 0.0 ? radius : 1.0};
}

void add_camera(Scene& scene, const Sphere& bounds) {
  Camera camera;
  camera.name = "added";
  const double distance = 1.05 * bounds.radius / std::sin(0.5 * camera.vertical_fov_rad);
  const glm::dvec3 towards = glm::normalize(glm::dvec3(-0.5, -0.35, -1.0));
  Node node;
  node.name = "added camera";
  node.translation = bounds.center - towards * distance;
  node.rotation = glm::quat_cast(scene::view_basis(towards, {0, 1, 0}));
  node.camera = static_cast<int>(scene.cameras.size());
  camera.near_m = static_cast<float>(0.1 * (distance - bounds.radius));
  scene.cameras.push_back(camera);
  scene.warnings.push_back(
      fmt::format("The scene has no camera; one that sees all of it was added at {:.4g}, {:.4g}, {:.4g}.",
                  node.translation.x, node.translation.y, node.translation.z));
  scene.nodes.push_back(std::move(node));
}

int first_camera(const Scene& scene) {
  const auto node =
      std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.camera >= 0; });
  return node->camera;
}

/// Needs a placed camera.
void add_light(Scene& scene, const Sphere& bounds) {
  constexpr double shoulder =
      0.1;  // of the distance to the middle: a camera inside a room keeps its light there
  const ViewRays view =
      evaluate_camera(scene, first_clip(scene), first_time_s(scene), first_camera(scene), 1, 1);
  const glm::dvec3 eye(view.eye);
  const double distance = std::max(glm::length(bounds.center - eye), 0.1 * bounds.radius);
  Node node;
  node.name = "added light";
  node.translation =
      eye + distance * shoulder * (glm::normalize(glm::dvec3(view.dx)) - glm::normalize(glm::dvec3(view.dy)));
  node.light = static_cast<int>(scene.lights.size());
  Light& light = scene.lights.emplace_back();
  light.name = "added";
  light.falloff = Falloff::none;
  scene.warnings.push_back(
      fmt::format("The scene has no light; a point light was added above the camera's shoulder at {:.4g}, "
                  "{:.4g}, {:.4g}.",
                  node.translation.x, node.translation.y, node.translation.z));
  scene.nodes.push_back(std::move(node));
}

bool is_placed(const Scene& scene, int Node::*what) {
  return std::any_of(scene.nodes.begin(), scene.nodes.end(),
                     [&](const Node& node) { return node.*what >= 0; });
}

std::vector<std::size_t> instances_per_mesh(const Scene& scene) {
  std::vector<std::size_t> counts(scene.meshes.size(), 0);
  for (const Node& node : scene.nodes) {
    if (node.mesh >= 0) ++counts[static_cast<std::size_t>(node.mesh)];
  }
  return counts;
}

/// Marks what is called `name`. Returns how many triangles that takes out, or -1 if nothing is called so.
std::ptrdiff_t leave_out(Scene& scene, const std::string& name, const std::vector<std::size_t>& instances) {
  bool found = false;
  std::vector<bool> named(scene.materials.size(), false);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name != name) continue;
    scene.materials[m].casts_shadow = false;
    named[m] = found = true;
  }
  std::size_t triangles = 0;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    const bool whole = mesh.name == name || mesh.source == name;
    if (whole) mesh.casts_shadow = false;
    found = found || whole;
    const auto hit = std::count_if(mesh.materials.begin(), mesh.materials.end(),
                                   [&](std::uint32_t material) { return whole || named[material]; });
    triangles += static_cast<std::size_t>(hit) * instances[m];
  }
  return found ? static_cast<std::ptrdiff_t>(triangles) : -1;
}

}  // namespace

void add_missing_camera_and_light(Scene& scene) {
  const bool needs_camera = !is_placed(scene, &Node::camera);
  const bool needs_light = !is_placed(scene, &Node::light);
  if (!needs_camera && !needs_light) return;
  const Sphere bounds = bounding_sphere(scene);
  if (needs_camera) add_camera(scene, bounds);
  if (needs_light) add_light(scene, bounds);
}

bool leave_out_casters(Scene& scene, const std::vector<std::string>& names, std::string& unmatched) {
  const std::vector<std::size_t> instances = instances_per_mesh(scene);
  for (const std::string& name : names) {
    const std::ptrdiff_t triangles = name.empty() ? -1 : leave_out(scene, name, instances);
    if (triangles < 0) {
      unmatched = name;
      return false;
    }
    scene.warnings.push_back(fmt::format("{} casts no shadow: {} triangles left out.", name, triangles));
  }
  return true;
}

}  // namespace tenebra
