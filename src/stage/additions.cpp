#include "stage/additions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include <tenebra/frame_geometry.h>
#include "scene/view_basis.h"
#include "stage/default_light.h"
#include "stage/framing.h"
#include "stage/room.h"

namespace tenebra::stage {
namespace {

int first_clip(const Scene& scene) {
  return scene.clips.empty() ? -1 : 0;
}
double first_time_s(const Scene& scene) {
  return scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
}

/// A place in the coordinates of the scene's file.
std::string in_file(const FileFrame& frame, const glm::dvec3& place) {
  const glm::dvec3 p = frame.to_file(place);
  return frame.is_identity() ? fmt::format("{:.4g}, {:.4g}, {:.4g}", p.x, p.y, p.z)
                             : fmt::format("{:.3f}, {:.3f}, {:.3f}", p.x, p.y, p.z);
}

void add_camera(Scene& scene, const Framing& framing, bool own_shape) {
  Camera camera;
  camera.name = "added";
  camera.vertical_fov_rad = framing.vertical_fov_rad;
  camera.near_m = framing.near_m;
  if (own_shape) camera.aspect = framing.aspect;
  Node node;
  node.name = "added camera";
  node.translation = framing.eye;
  node.rotation = glm::quat_cast(framing.basis);
  node.camera = static_cast<int>(scene.cameras.size());
  scene.cameras.push_back(camera);
  scene.warnings.push_back(fmt::format(
      "The scene has no camera; one was added at {}{}. At the start the scene fills {:.0f} % of its "
      "picture.",
      in_file(scene.frame, node.translation), framing.lamp ? ", in the closed room that it is" : "",
      100 * framing.subject_share));
  scene.nodes.push_back(std::move(node));
}

/// To the right of the first placed camera, at the start.
glm::dvec3 right_of_camera(const Scene& scene) {
  const auto node =
      std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.camera >= 0; });
  return evaluate_camera(scene, first_clip(scene), first_time_s(scene), node->camera, 1, 1).dx;
}

void add_light(Scene& scene, Node node, LightType type, float intensity) {
  node.light = static_cast<int>(scene.lights.size());
  Light& light = scene.lights.emplace_back();
  light.name = node.name;
  light.type = type;
  light.falloff = Falloff::none;
  light.intensity = intensity;
  scene.ambient_light = glm::vec3(default_ambient);
  if (scene.background == glm::vec3(0.0f)) scene.background = glm::vec3(default_horizon);
  scene.nodes.push_back(std::move(node));
}

void add_sun(Scene& scene, const glm::dvec3& towards) {
  Node node;
  node.name = "added sun";
  node.rotation = glm::quat_cast(scene::view_basis(-towards, {0, 1, 0}));
  add_light(scene, std::move(node), LightType::directional, default_sun);
  scene.warnings.push_back(
      "The scene has no light; a sun from the left behind the camera, 50 degrees high, and the light of a "
      "soft sky were added.");
}

/// No sun reaches into a closed room.
void add_lamp(Scene& scene, const glm::dvec3& at) {
  Node node;
  node.name = "added lamp";
  node.translation = at;
  add_light(scene, std::move(node), LightType::point, default_lamp);
  scene.warnings.push_back("The scene has no light; a lamp below the ceiling and ambient light were added.");
}

/// Whether three quarters of the ground, under the scene and its shadow, are covered by what faces up within
/// a twentieth of the scene's height from below.
bool has_floor(const Subject& subject) {
  const glm::dvec3 size = subject.high - subject.low;
  const double band = subject.low.y + 0.1 * size.y;
  const double shadow = 0.6 * size.y;  // the sun's, along either axis, in the mean
  double covered = 0;
  for (const glm::uvec3& triangle : subject.first.triangles) {
    if (triangle == glm::uvec3(0)) continue;
    glm::dvec3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = glm::dvec3(subject.first.positions[triangle[k]]);
    const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
    if (std::max({v[0].y, v[1].y, v[2].y}) <= band && normal.y > 0.9 * glm::length(normal))
      covered += 0.5 * normal.y;
  }
  return covered > 0 && covered >= 0.75 * (size.x + shadow) * (size.z + shadow);
}

/// As bright in the sun as the background: only the shadow is seen.
Material floor_material(float background) {
  Material material;
  material.name = "added floor";
  material.model = SurfaceModel::phong;
  const auto high = static_cast<float>(towards_sun({}).y);
  material.base_color = glm::vec3(background / (default_ambient + default_sun * high));
  material.specular = glm::vec3(0.0f);
  return material;
}

/// Under the box and the sun's shadow of it.
void add_floor(Scene& scene, const Subject& subject, double floor_y, const glm::dvec3& sun) {
  const glm::dvec3 shift = (floor_y - subject.high.y) / sun.y * sun, pad(0.5 * subject.radius_m());
  const glm::vec3 low(glm::min(subject.low, subject.low + shift) - pad),
      high(glm::max(subject.high, subject.high + shift) + pad);
  const auto y = static_cast<float>(floor_y);
  Mesh mesh;
  mesh.name = "added floor";
  mesh.positions = {{low.x, y, low.z}, {low.x, y, high.z}, {high.x, y, high.z}, {high.x, y, low.z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials.assign(2, static_cast<std::uint32_t>(scene.materials.size()));
  scene.materials.push_back(floor_material(default_horizon));
  Node node;
  node.name = "added floor";
  node.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(std::move(node));
  const glm::dvec3 floor = scene.frame.to_file({0, floor_y, 0});
  const double height = scene.frame.up == UpAxis::z ? floor.z : floor.y;
  scene.warnings.push_back(fmt::format(
      "The scene has neither light nor floor; a floor that shows its shadow was added at a height "
      "of {:.4g} (--floor none leaves it out).",
      height));
}

bool is_placed(const Scene& scene, int Node::*what) {
  return std::any_of(scene.nodes.begin(), scene.nodes.end(),
                     [&](const Node& node) { return node.*what >= 0; });
}

}  // namespace

AddedParts add_missing_parts(Scene& scene, const Additions& wish) {
  AddedParts added;
  added.camera = !is_placed(scene, &Node::camera);
  added.light = !is_placed(scene, &Node::light);
  if (!added.camera && !added.light) return added;
  const Subject subject = subject_of(scene);
  const auto room = added.camera ? frame_room(subject, wish.aspect) : std::nullopt;
  added.lamp = added.light && room;
  added.floor = wish.floor && added.light && !room && !subject.empty() && !has_floor(subject);
  // A thousandth below: what lies flat on the ground is not in the floor's plane.
  const double floor_y = subject.low.y - 1e-3 * subject.radius_m();
  if (added.camera) {
    const auto shadow = added.floor ? std::optional(floor_y) : std::nullopt;
    add_camera(scene, room ? *room : frame_subject(subject, shadow, wish.aspect), !wish.aspect);
  }
  if (added.lamp) add_lamp(scene, *room->lamp);
  if (!added.light || added.lamp) return added;
  const glm::dvec3 sun = towards_sun(compass_of(right_of_camera(scene)));
  if (added.floor) add_floor(scene, subject, floor_y, sun);
  add_sun(scene, sun);
  return added;
}

void add_missing_camera_and_light(Scene& scene) {
  add_missing_parts(scene, {.floor = false, .aspect = 1.0f});
}

}  // namespace tenebra::stage
