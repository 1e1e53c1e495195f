#include "options/scene_options.h"

namespace tenebra::viewer {
namespace {

void add_file(CLI::App& command, SceneOptions& options) {
  add_text(command, "SCENE", options.file, "Scene file (tenebra info --formats)");
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  add_file(command, options);
  add_settings(command, settings::scene_table(), options);
}

void add_content_options(CLI::App& command, SceneOptions& options) {
  add_file(command, options);
  add_settings(command, settings::scene_table(), options,
               {"scene", "up-axis", "unit", "offset", "no-cast", "cast-all", "cone-sides", "cutout-limit",
                "texture-path", "file-root", "sky", "set-light", "add-light", "set-material", "set-node",
                "time", "fps", "clip"});
}

void add_import_options(CLI::App& command, SceneOptions& options) {
  add_settings(command, settings::scene_table(), options,
               {"scene", "up-axis", "unit", "offset", "texture-path", "file-root"});
}

}  // namespace tenebra::viewer
