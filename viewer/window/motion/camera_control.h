// The viewer's camera: the scene's own, or a free one that orbits a point or flies. Pure arithmetic.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include <tenebra/frame_geometry.h>

namespace tenebra::viewer {

enum class CameraMode { scene, orbit, fly };

/// A camera as `tenebra render` takes it: --eye, --look-at, --up, --fov.
struct FreeCamera {
  glm::vec3 eye{0, 0, 1};
  glm::vec3 target{0.0f};
  glm::vec3 up{0, 1, 0};
  double fov_deg = 45;  ///< full, vertical

  bool operator==(const FreeCamera&) const = default;
};

/// "--eye X,Y,Z --look-at X,Y,Z --up X,Y,Z --fov D", each number with as many digits as tell it apart.
std::string camera_arguments(const FreeCamera& camera, const FileFrame& frame);

/// The free camera that sees what `view` sees, looking at a point `distance_m` away (orthographic views,
/// which have no field of view: from far enough to see as much at that point).
FreeCamera free_camera(const ViewRays& view, int width, int height, float distance_m);

/// Moves by the mouse and keys. Angles in radians; `right`, `down` as the mouse moves.
void orbit(FreeCamera& camera, float right_rad, float down_rad);  ///< the eye around the target
/// The eye and the target around any point.
void orbit(FreeCamera& camera, float right_rad, float down_rad, glm::vec3 about);
void look_around(FreeCamera& camera, float right_rad, float down_rad);  ///< the target around the eye
void pan(FreeCamera& camera, glm::vec2 pixels, int height);  ///< the target stays under the pointer
void zoom(FreeCamera& camera, float steps);                  ///< towards the target; 1: a notch
void fly(FreeCamera& camera, glm::vec3 right_up_forward_m);  ///< eye and target
void focus(FreeCamera& camera, glm::vec3 point);             ///< turns towards it; orbits it then

/// Sees all of a box, no more than that takes, the way it looks now; in a picture of `aspect` (width by
/// height).
void frame(FreeCamera& camera, glm::vec3 low, glm::vec3 high, double aspect);

/// Window position in pixels of a world point, row 0 at the top; z > 0: in front of the eye (units of d0).
glm::dvec3 pixel_of(const ViewRays& view, glm::dvec3 point);

}  // namespace tenebra::viewer
