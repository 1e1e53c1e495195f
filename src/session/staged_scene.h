// A scene file made ready for drawing: read, with what it lacks added, its clip and camera chosen.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "io/image.h"
#include "settings/method_settings.h"
#include "settings/scene_settings.h"
#include "stage/additions.h"

namespace tenebra::session {

struct StagedScene {
  Scene scene;          ///< with cameras and lights added and casters left out, before edits;
                        ///< Scene::lights in the order of the nodes, each node its own
  int clip = -1;        ///< -1: the scene does not move
  int camera = 0;       ///< index into Scene::cameras; means nothing where there are none
  settings::Size size;  ///< of pictures: the settings', or what the camera asks for
  std::optional<io::ImageF> environment;  ///< the settings', or the soft sky of an added light
  settings::SceneDisplay display;
  stage::AddedParts added;
  bool light_has_units =
      false;        ///< that of the file, which states no surroundings: added lights have them too
  double fps = 30;  ///< where the clip does not number its frames itself
  std::vector<std::filesystem::path> inputs;  ///< the files that were read

  /// Frames of the clip; 1 without a clip.
  int frames() const;
  /// Time of frame `frame` of the clip; 0 without a clip.
  double time_of_frame(int frame) const;
};

/// What a scene gets that its file lacks.
enum class Staging {
  for_pictures,  ///< what stage::add_missing_parts adds: there is a camera, and light
  for_light      ///< the same light, and no floor; stage::remove_added takes the rest out
};

/// Reads the file of the settings and fits them to it. Fails on what the scene does not have.
Expected<StagedScene> stage_scene(const settings::SceneSettings& settings,
                                  Staging staging = Staging::for_pictures);

/// Index of the camera called `wanted`, else numbered so; without `wanted` the first. Needs a camera.
Expected<int> choose_camera(const Scene& scene, const std::optional<std::string>& wanted);

}  // namespace tenebra::session
