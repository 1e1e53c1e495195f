// The options that choose what is looked at: scene, lights, moment, camera. The commands render, view, verify
// and trade share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/import_scene.h"
#include "options/option_values.h"
#include "shell/command_line.h"
#include "stage/edits/scene_edits.h"

namespace tenebra::viewer {

struct SceneOptions {
  std::string file;  ///< positional SCENE; empty: not given
  formats::ImportOptions import;
  std::vector<std::string> no_cast;
  int cutout_limit = 1'000'000;      ///< triangles that cutting out alpha may add
  bool cast_all = false;             ///< skies cast shadows too
  std::optional<Transfer> transfer;  ///< none: the format's own
  std::string environment;           ///< a Radiance picture; empty: none
  bool floor = true;                 ///< one is added where light and floor are missing
  bool plain = false;                ///< surfaces without textures and gloss (stage::make_plain)

  bool meter_exposure = false;  ///< a method asks for --exposure auto

  std::optional<double> time_s;
  double fps = 30.0;
  std::optional<std::string> clip;

  std::optional<std::string> camera;
  std::optional<glm::vec3> eye;
  glm::vec3 look_at{0.0f};
  glm::vec3 up{0, 1, 0};
  std::optional<double> fov_deg;
  std::optional<Size> size;

  stage::SceneEdits edits;
};

/// Adds SCENE, --scene, --no-cast, --cast-all, --cone-sides, --cutout-limit, --texture-path, --transfer,
/// --environment, --surfaces, --floor, --set-light, --add-light, --set-material, --set-node, --time, --fps,
/// --clip and those of the camera, --size too; they are read into `options`, which must live as long. A
/// command makes SCENE required with option_of(command, "SCENE").required().
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Of these SCENE, --scene, --no-cast, --cast-all, --cone-sides, --cutout-limit, --texture-path, those that
/// change lights, materials and nodes, --time, --fps and --clip; for commands without a picture.
void add_content_options(CLI::App& command, SceneOptions& options);

/// Adds --texture-path; for commands without the options above.
void add_texture_path(CLI::App& command, formats::ImportOptions& options);

/// The options for another file in place of this one: those that concern no part of a scene stay.
SceneOptions options_for(const std::string& file, const SceneOptions& before);

/// What single options cannot check: combinations.
Expected<void> check_scene_options(const SceneOptions& options);

}  // namespace tenebra::viewer
