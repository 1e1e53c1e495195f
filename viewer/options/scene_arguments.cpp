#include "options/scene_arguments.h"

#include <fmt/core.h>

#include "options/method_arguments.h"

namespace tenebra::viewer {
namespace {

/// Adds "NAME VALUE " to a text.
void add_argument(std::string& text, const char* name, const std::string& value) {
  text += fmt::format("{} {} ", name, shell_word(value));
}

std::string three(const glm::vec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

}  // namespace

std::string dressing_arguments(const SceneOptions& options) {
  std::string text;
  if (!options.import.scene.empty()) add_argument(text, "--scene", options.import.scene);
  for (const std::string& name : options.no_cast) add_argument(text, "--no-cast", name);
  if (options.cast_all) text += "--cast-all ";
  if (!options.floor) add_argument(text, "--floor", "none");
  if (options.plain) add_argument(text, "--surfaces", "plain");
  if (options.cutout_limit != SceneOptions{}.cutout_limit)
    add_argument(text, "--cutout-limit", fmt::format("{}", options.cutout_limit));
  if (options.import.cone_sides != formats::ImportOptions{}.cone_sides)
    add_argument(text, "--cone-sides", fmt::format("{}", options.import.cone_sides));
  if (options.transfer)
    add_argument(text, "--transfer", *options.transfer == Transfer::srgb ? "srgb" : "display");
  if (!options.environment.empty()) add_argument(text, "--environment", options.environment);
  for (const auto& folder : options.import.texture_paths)
    add_argument(text, "--texture-path", folder.string());
  return text;
}

std::string view_arguments(const SceneOptions& options) {
  std::string text;
  if (options.clip) add_argument(text, "--clip", *options.clip);
  if (options.fps != SceneOptions{}.fps) add_argument(text, "--fps", fmt::format("{}", options.fps));
  if (options.camera) add_argument(text, "--camera", *options.camera);
  if (options.eye) {
    add_argument(text, "--eye", three(*options.eye));
    add_argument(text, "--look-at", three(options.look_at));
    if (options.up != SceneOptions{}.up) add_argument(text, "--up", three(options.up));
  }
  if (options.fov_deg) add_argument(text, "--fov", fmt::format("{}", *options.fov_deg));
  if (options.size)
    add_argument(text, "--size", fmt::format("{}x{}", options.size->width, options.size->height));
  return text;
}

}  // namespace tenebra::viewer
