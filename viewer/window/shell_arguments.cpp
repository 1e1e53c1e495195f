#include "window/shell_arguments.h"

#include <fmt/core.h>

#include <algorithm>

#include "options/method_arguments.h"
#include "options/scene_arguments.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

/// What --camera and --clip find `index` by: its number, unless that is the name of one.
template <class Named>
std::string number_or_name(const std::vector<Named>& list, int index) {
  const std::string number = fmt::format("{}", index);
  const bool taken =
      std::any_of(list.begin(), list.end(), [&](const Named& named) { return named.name == number; });
  return taken ? list[static_cast<std::size_t>(index)].name : number;
}

/// Light that was added, or not, when the scene was opened, and that the lights of now would have added
/// otherwise.
const char* sky_of(const ViewState& state) {
  if (state.options.sky != stage::Sky::automatic || !state.options.environment.empty()) return "";
  const bool users = !state.edits.added.empty() ||
                     makes_emissive_lights(state.slots[static_cast<std::size_t>(state.active)]);
  if (state.scene->added.light) return users ? "--sky sun " : "";
  return state.scene->scene.lights.empty() && !users ? "--sky none " : "";
}

}  // namespace

std::string shell_arguments(const ViewState& state, double time_s, Size size) {
  const Scene& scene = state.scene->scene;
  std::string text = dressing_arguments(state.options) + sky_of(state);
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("{} {} ", name, shell_word(value));
  };
  if (state.clip > 0) add("--clip", number_or_name(scene.clips, state.clip));
  if (state.camera_mode == CameraMode::scene) {
    add("--camera", number_or_name(scene.cameras, state.camera));
    if (state.options.fov_deg && !state.options.eye) add("--fov", fmt::format("{}", *state.options.fov_deg));
  } else {
    text += camera_arguments(state.free, scene.frame) + " ";
  }
  text += fmt::format("--time {} --size {}x{}", time_s, size.width, size.height);
  const std::string method = method_arguments(state.slots[static_cast<std::size_t>(state.active)]);
  if (!method.empty()) text += " " + method;
  for (const EditOption& edit : edit_options(state.edits))
    text += fmt::format(" {} {}", edit.name, shell_word(edit.value));
  return text;
}

}  // namespace tenebra::viewer
