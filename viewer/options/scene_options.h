// The options that choose what is looked at: scene, lights, moment, camera. The commands render, view, verify
// and trade share them.
#pragma once

#include <string>

#include "options/option_values.h"
#include "settings/scene_settings.h"
#include "shell/command_line.h"

namespace tenebra::viewer {

using SceneOptions = settings::SceneSettings;

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
