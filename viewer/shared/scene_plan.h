// A scene made ready for drawing: loaded, with its clip and camera chosen. All commands that draw share it.
#pragma once

#include <tenebra/frame_geometry.h>
#include "io/image.h"
#include "options/method_options.h"
#include "options/scene_options.h"
#include "stage/additions.h"

namespace tenebra::viewer {

struct ScenePlan {
  Scene scene;  ///< with cameras and lights added and casters left out; Scene::lights in the order of the
                ///< nodes that have them, each node its own
  int clip = -1;
  int camera = 0;                         ///< index into scene.cameras; unused with --eye
  Size size;                              ///< --size, or what the camera asks for
  std::optional<io::ImageF> environment;  ///< --environment, or the soft sky of an added light
  SceneDisplay display;
  stage::AddedParts added;
};

/// Imports the scene and fits the options to it. Fails on what the scene does not have.
Expected<ScenePlan> plan_scene(const SceneOptions& options);

/// The camera of the options at one instant, for a picture of `size`.
ViewRays view_of(const ScenePlan& plan, const SceneOptions& options, double time_s, Size size);

/// A camera of the scene, by number. One that was added shows all in pictures narrower than its shape too.
ViewRays view_of_camera(const ScenePlan& plan, int clip, int camera, double time_s, Size size);

/// Fails if the scene with its edits lacks light `light` (-1: all) at `time_s`; else the number of its
/// lights.
Expected<int> check_light(const ScenePlan& plan, const stage::SceneEdits& edits, int light, double time_s);

}  // namespace tenebra::viewer
