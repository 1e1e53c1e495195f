#include "stage/additions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include <tenebra/frame_geometry.h>
#include "scene/view_basis.h"
#include "stage/default_light.h"
#include "stage/framing.h"
#include "stage/places.h"
#include "stage/room.h"
#include "stage/shadow_floor.h"

namespace tenebra::stage {
namespace {

int first_clip(const Scene& scene) {
  return scene.clips.empty() ? -1 : 0;
}
double first_time_s(const Scene& scene) {
  return scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
}

const char* assumed_up(UpAxis up) {
  return up == UpAxis::y ? ", with Y up (--up-axis z if it is Z)" : ", with Z up (--up-axis y if it is Y)";
}

/// Returns what is to be said of it.
std::string add_camera(Scene& scene, const Framing& framing, const Additions& wish) {
  Camera camera;
  camera.name = "added";
  camera.vertical_fov_rad = framing.vertical_fov_rad;
  camera.near_m = framing.near_m;
  if (!wish.aspect) camera.aspect = framing.aspect;
  Node node;
  node.name = "added camera";
  node.translation = framing.eye;
  node.rotation = glm::quat_cast(framing.basis);
  node.camera = static_cast<int>(scene.cameras.size());
  scene.cameras.push_back(camera);
  std::string said = fmt::format(
      "The scene has no camera; one was added at {}{}{}. At the start the scene fills {:.0f} % of its "
      "picture.",
      place_text(scene.frame, node.translation), framing.lamp ? ", in the closed room that it is" : "",
      wish.up_assumed ? assumed_up(scene.frame.up) : "", 100 * framing.subject_share);
  scene.nodes.push_back(std::move(node));
  return said;
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

/// What to say beside an added light of meshes that could shine.
const char* instead(bool shines) {
  return shines ? "; with --shadows soft --emissive-lights its emissive meshes shine instead" : "";
}

void add_sun(Scene& scene, const glm::dvec3& towards, bool shines) {
  Node node;
  node.name = "added sun";
  node.rotation = glm::quat_cast(scene::view_basis(-towards, {0, 1, 0}));
  add_light(scene, std::move(node), LightType::directional, default_sun);
  scene.lights.back().diameter_deg = default_sun_deg;
  scene.warnings.push_back(fmt::format(
      "The scene has no light; a sun from the left behind the camera, 50 degrees high, and the light of a "
      "soft sky were added (--sky none leaves them out{}).",
      instead(shines)));
}

/// No sun reaches into a closed room.
void add_lamp(Scene& scene, const glm::dvec3& at, bool shines) {
  Node node;
  node.name = "added lamp";
  node.translation = at;
  add_light(scene, std::move(node), LightType::point, default_lamp);
  scene.warnings.push_back(fmt::format(
      "The scene has no light; a lamp below the ceiling and ambient light were added{}.", instead(shines)));
}

bool is_placed(const Scene& scene, int Node::*what) {
  return std::any_of(scene.nodes.begin(), scene.nodes.end(),
                     [&](const Node& node) { return node.*what >= 0; });
}

}  // namespace

AddedParts add_missing_parts(Scene& scene, const Additions& wish) {
  AddedParts added{.own_nodes = scene.nodes.size(),
                   .own_ambient = scene.ambient_light,
                   .own_background = scene.background};
  added.camera = !is_placed(scene, &Node::camera);
  added.light = wish.sky == Sky::sun || (wish.sky == Sky::automatic && !is_placed(scene, &Node::light));
  if (!added.camera && !added.light) return added;
  const Subject subject = subject_of(scene);
  const auto room = added.camera ? frame_room(subject, wish.aspect) : std::nullopt;
  added.lamp = added.light && room;
  const bool floor = wish.floor && added.light && !room && !subject.empty() && !has_floor(subject);
  added.floor = floor && wish.for_pictures;
  // A thousandth below: what lies flat on the ground is not in the floor's plane.
  added.floor_y = subject.low.y - 1e-3 * subject.radius_m();
  if (added.camera) {
    const auto shadow = floor ? std::optional(added.floor_y) : std::nullopt;
    std::string said = add_camera(scene, room ? *room : frame_subject(subject, shadow, wish.aspect), wish);
    if (wish.for_pictures) scene.warnings.push_back(std::move(said));
  }
  if (added.lamp) add_lamp(scene, *room->lamp, wish.shines);
  if (!added.light || added.lamp) return added;
  const glm::dvec3 sun = towards_sun(compass_of(right_of_camera(scene)));
  if (added.floor) add_shadow_floor(scene, subject, added.floor_y);
  add_sun(scene, sun, wish.shines);
  return added;
}

void remove_added(const AddedParts& added, Scene& scene) {
  scene.nodes.resize(added.own_nodes);
  if (added.light) scene.lights.pop_back();
  if (added.camera) scene.cameras.pop_back();
  scene.ambient_light = added.own_ambient;
  scene.background = added.own_background;
}

void hide_floor_from_below(const AddedParts& added, double eye_y, FrameGeometry& frame) {
  if (!added.floor || eye_y >= added.floor_y || frame.parts.empty()) return;
  std::fill(frame.triangles.begin() + static_cast<std::ptrdiff_t>(frame.parts.back()), frame.triangles.end(),
            glm::uvec3(0));
}

void add_missing_camera_and_light(Scene& scene) {
  add_missing_parts(scene, {.floor = false, .aspect = 1.0f});
}

}  // namespace tenebra::stage
