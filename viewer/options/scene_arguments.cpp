#include "options/scene_arguments.h"

#include "settings/tables.h"

namespace tenebra::viewer {
namespace {

std::string of(const SceneOptions& options, std::initializer_list<std::string_view> names) {
  const std::string text = settings::arguments(settings::scene_table(), options, names);
  return text.empty() ? text : text + " ";
}

}  // namespace

std::string dressing_arguments(const SceneOptions& options) {
  return of(options,
            {"scene", "up-axis", "unit", "offset", "no-cast", "cast-all", "cone-sides", "cutout-limit",
             "texture-path", "file-root", "transfer", "environment", "sky", "floor", "surfaces"});
}

std::string view_arguments(const SceneOptions& options) {
  return of(options, {"camera", "eye", "look-at", "up", "fov", "size", "fps", "clip"});
}

}  // namespace tenebra::viewer
