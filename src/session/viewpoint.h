// From where a staged scene is seen: one of its cameras, or one that the user places.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include <tenebra/frame_geometry.h>
#include "session/staged_scene.h"

namespace tenebra::session {

/// A camera that stands where the user puts it, in the scene's coordinates.
struct PlacedCamera {
  glm::vec3 eye{0, 0, 1};
  glm::vec3 look_at{0.0f};
  glm::vec3 up{0, 1, 0};
  double fov_deg = 45;  ///< full, vertical
};

struct Viewpoint {
  int clip = -1;
  int camera = 0;                      ///< of the scene
  std::optional<PlacedCamera> placed;  ///< in place of the scene's
};

/// The one of the settings' eye, which are in the coordinates of the scene's file.
PlacedCamera placed_camera(const FileFrame& frame, const settings::SceneSettings& settings);

/// What the settings ask for.
Viewpoint viewpoint_of(const StagedScene& staged, const settings::SceneSettings& settings);

/// Its rays at one instant, for a picture of `size`. A camera that was added shows all in pictures narrower
/// than its shape too.
ViewRays rays_of(const StagedScene& staged, const Viewpoint& viewpoint, double time_s, settings::Size size);

float radians(double degrees);

}  // namespace tenebra::session
