// The options that choose what is looked at: scene, lights, moment, camera. The commands render, view, verify
// and trade share them.
#pragma once

#include "options/setting_options.h"
#include "options/settings_names.h"

namespace tenebra::viewer {

/// Adds SCENE and all settings of it; they are read into `options`, which must live as long. A command makes
/// SCENE required with option_of(command, "SCENE").required().
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Of these SCENE and those that concern its file, lights, materials, nodes and moment; for commands without
/// a picture.
void add_content_options(CLI::App& command, SceneOptions& options);

/// Of these how the file is read, without SCENE; for commands that only look at it.
void add_import_options(CLI::App& command, SceneOptions& options);

}  // namespace tenebra::viewer
