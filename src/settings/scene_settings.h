// What is looked at: the file and how it is read and dressed, the moment, the camera.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/import_scene.h"
#include "settings/values.h"
#include "stage/additions.h"
#include "stage/edits/scene_edits.h"

namespace tenebra::settings {

struct SceneSettings {
  std::string file;  ///< empty: not given
  formats::ImportOptions import;
  std::vector<std::string> no_cast;
  int cutout_limit = 1'000'000;      ///< triangles that cutting out alpha may add
  bool cast_all = false;             ///< skies cast shadows too
  std::optional<Transfer> transfer;  ///< none: the format's own
  std::string environment;           ///< a Radiance picture; empty: none
  stage::Sky sky = stage::Sky::automatic;
  bool floor = true;   ///< one is added where light and floor are missing
  bool plain = false;  ///< surfaces without textures and gloss (make_plain)

  bool meter_exposure = false;   ///< a method asks for --exposure auto
  bool exposure_given = false;   ///< all methods have an exposure of their own
  bool shows = true;             ///< something is drawn that light and exposure change; false: masks alone
  bool emissive_lights = false;  ///< a method makes lights of emissive meshes

  std::optional<double> time_s;
  double fps = 30.0;
  std::optional<std::string> clip;

  std::optional<std::string> camera;
  // In the coordinates of the scene's file.
  std::optional<glm::dvec3> eye;
  glm::dvec3 look_at{0.0};
  std::optional<glm::vec3> up;  ///< none: the file's up axis
  std::optional<double> fov_deg;
  std::optional<Size> size;

  stage::SceneEdits edits;
};

/// The settings for another file in place of this one: those that concern no part of a scene stay.
SceneSettings settings_for(const std::string& file, const SceneSettings& before);

/// What single settings cannot check: combinations.
Expected<void> check_scene_settings(const SceneSettings& scene);

}  // namespace tenebra::settings
