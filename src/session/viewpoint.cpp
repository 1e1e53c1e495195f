#include "session/viewpoint.h"

#include <numbers>

namespace tenebra::session {
namespace {

/// The near plane of a placed camera lies at this part of the way to the point looked at.
constexpr float near_of_distance = 1e-3f;

ViewRays rays_of_camera(const StagedScene& staged, int clip, int camera, double time_s, settings::Size size) {
  ViewRays view = evaluate_camera(staged.scene, clip, time_s, camera, size.width, size.height);
  const bool added = staged.added.camera && camera + 1 == static_cast<int>(staged.scene.cameras.size());
  const float shape = added ? staged.scene.cameras.back().aspect.value_or(0.0f) : 0.0f;
  const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  const float wider = shape * height / width;
  if (!(wider > 1)) return view;
  const glm::vec3 middle = view.d0 + 0.5f * width * view.dx + 0.5f * height * view.dy;
  view.dx *= wider;
  view.dy *= wider;
  view.d0 = middle - 0.5f * width * view.dx - 0.5f * height * view.dy;
  return view;
}

}  // namespace

float radians(double degrees) {
  return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

Viewpoint viewpoint_of(const StagedScene& staged, const settings::SceneSettings& settings) {
  Viewpoint viewpoint{.clip = staged.clip, .camera = staged.camera, .placed = {}};
  if (settings.eye) viewpoint.placed = placed_camera(staged.scene.frame, settings);
  return viewpoint;
}

PlacedCamera placed_camera(const FileFrame& frame, const settings::SceneSettings& settings) {
  PlacedCamera camera;
  camera.eye = glm::vec3(frame.to_scene(settings.eye.value_or(frame.origin)));
  camera.look_at = glm::vec3(frame.to_scene(settings.look_at));
  if (settings.up) camera.up = glm::vec3(frame.direction_to_scene(glm::dvec3(*settings.up)));
  camera.fov_deg = settings.fov_deg.value_or(camera.fov_deg);
  return camera;
}

ViewRays rays_of(const StagedScene& staged, const Viewpoint& viewpoint, double time_s, settings::Size size) {
  if (!viewpoint.placed) return rays_of_camera(staged, viewpoint.clip, viewpoint.camera, time_s, size);
  const PlacedCamera& placed = *viewpoint.placed;
  const float near_m = near_of_distance * glm::distance(placed.eye, placed.look_at);
  return look_at(placed.eye, placed.look_at, placed.up, radians(placed.fov_deg), near_m, size.width,
                 size.height);
}

}  // namespace tenebra::session
