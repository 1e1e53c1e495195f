// Parts that a picture needs and a file lacks: a camera, light, a floor for the shadow.
#pragma once

#include <optional>

#include <tenebra/frame_geometry.h>

namespace tenebra::stage {

/// Light that a scene gets beside its own.
enum class Sky {
  automatic,  ///< what is missing: a sun and a sky where there is no light, a sky alone where lights leave
              ///< the rest black
  none,
  soft,  ///< a sky alone
  sun    ///< a sun and a sky, beside all other lights
};

/// What add_missing_parts is to add.
struct Additions {
  bool floor = true;  ///< a floor under scenes that have neither light nor floor
  std::optional<float>
      aspect;  ///< width / height of the picture; none: what suits the scene (Camera::aspect)
  Sky sky = Sky::automatic;
  bool up_assumed = false;   ///< neither file nor user says what is up: the sentence of an added camera does
  bool shines = false;       ///< meshes could be lights: the sentence of an added light says how
  bool for_pictures = true;  ///< false: no floor is made, and the camera, which remove_added takes out, is
                             ///< not spoken of; light and camera stand where they would in pictures
};

/// What add_missing_parts added.
struct AddedParts {
  bool camera = false;        ///< a camera that sees everything, or stands in a closed room
  bool light = false;         ///< a sun and the light of a sky, or a lamp and ambient light
  bool lamp = false;          ///< the light is a lamp in a closed room
  bool floor = false;         ///< a floor to catch the shadow
  double floor_y = 0;         ///< its height, metres in the scene's coordinates
  bool sky = false;           ///< ambient light alone, beside the scene's lights (session/brightness.h)
  std::size_t own_nodes = 0;  ///< of the scene before
  glm::vec3 own_ambient{0.0f}, own_background{0.0f};  ///< the scene's before
};

/// Adds what a picture needs if the file lacks it, and says so in scene.warnings:
/// - a camera from the front, nearby, that shows everything at all times of the first clip, and some of the
///   shadow on an added floor, in pictures of its aspect ratio and wider ones; or, where the scene is a
///   closed room, one that stands in it;
/// - a sun from the left behind the camera, with the ambient light and (unless the file states one) the
///   background of a soft sky; in a closed room whose camera was added a lamp below the ceiling;
/// - with that sun, where nothing that faces up covers most of the ground, a floor to catch the shadow: the
///   scene's last mesh, as bright in the sun as the background, and fading out where the shadow of a sun 30
///   degrees high would end. It casts none.
AddedParts add_missing_parts(Scene& scene, const Additions& wish = {});

/// The scene without what was added, but for a floor. To be called while the added nodes and lights are the
/// last.
void remove_added(const AddedParts& added, Scene& scene);

/// Drops the triangles of the added floor, the last mesh, from a frame that is seen from below it: from the
/// height `eye_y`, metres in the scene's coordinates.
void hide_floor_from_below(const AddedParts& added, double eye_y, FrameGeometry& frame);

/// Adds a camera that sees everything in a square picture, and a sun with the light of a soft sky, where the
/// file lacks them. Says so in scene.warnings.
void add_missing_camera_and_light(Scene& scene);

}  // namespace tenebra::stage
