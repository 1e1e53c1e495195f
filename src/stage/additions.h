// Parts that a picture needs and a file lacks: a camera, light, a floor for the shadow.
#pragma once

#include <tenebra/scene.h>
#include <optional>

namespace tenebra::stage {

/// What add_missing_parts is to add.
struct Additions {
  bool floor = true;  ///< a floor under scenes that have neither light nor floor
  std::optional<float>
      aspect;  ///< width / height of the picture; none: what suits the scene (Camera::aspect)
};

/// What add_missing_parts added.
struct AddedParts {
  bool camera = false;  ///< a camera that sees everything, or stands in a closed room
  bool light = false;   ///< a sun and the light of a sky, or a lamp and ambient light
  bool lamp = false;    ///< the light is a lamp in a closed room
  bool floor = false;   ///< a floor to catch the shadow
};

/// Adds what a picture needs if the file lacks it, and says so in scene.warnings:
/// - a camera from the front, nearby, that shows everything at all times of the first clip, and some of the
///   shadow on an added floor, in pictures of its aspect ratio and wider ones; or, where the scene is a
///   closed room, one that stands in it;
/// - a sun from the left behind the camera, with the ambient light and (unless the file states one) the
///   background of a soft sky; in a closed room whose camera was added a lamp below the ceiling;
/// - with that light, where nothing that faces up covers most of the ground, a floor to catch the shadow: a
///   flat mesh, the scene's last, as bright in the sun as the background.
AddedParts add_missing_parts(Scene& scene, const Additions& wish = {});

/// Adds a camera that sees everything in a square picture, and a sun with the light of a soft sky, where the
/// file lacks them. Says so in scene.warnings.
void add_missing_camera_and_light(Scene& scene);

}  // namespace tenebra::stage
