// tenebra view: a window on an animated scene.
#include <memory>

#include "commands/command.h"
#include "options/memory_option.h"
#include "shared/bundled_scene.h"
#include "shared/render_plan.h"
#include "shell/last_words.h"
#include "shell/memory_limit.h"
#include "window/glfw_window.h"
#include "window/view_options.h"

namespace tenebra::viewer {
namespace {

constexpr const char* view_examples =
    "Examples:\n"
    "  tenebra view\n"
    "      the bundled city; ? shows the keys\n"
    "  tenebra view scenes/gallery.glb --play --overlay nodes\n"
    "      where the work of hard shadows goes\n"
    "  tenebra view scenes/court.glb --shadows soft --compare=\"--shadows hard\"\n"
    "      soft and hard shadows, with a line to wipe between them\n"
    "  tenebra view scenes/city.glb --size 1280x720 --record out/%04d.png --exit-after 300\n"
    "      the first 300 frames as pictures, the same bits as tenebra render\n"
    "\n"
    "The window needs a display with OpenGL 3.3; tenebra render needs no display.";

/// The scene, where options speak of its lights: what it does not have is said before a window opens.
Expected<std::shared_ptr<const session::StagedScene>> stage_with_lights(const ViewOptions& options) {
  auto staged = session::stage_scene(options.scene);
  if (!staged) return tl::unexpected(staged.error());
  const render::RenderSettings& render = options.method.render;
  const int light = render.area_lights.emissive_quads ? -1 : render.light;
  if (auto checked = check_light(*staged, options.scene.edits, light, options.scene.time_s.value_or(0));
      !checked) {
    return tl::unexpected(checked.error());
  }
  return std::make_shared<const session::StagedScene>(std::move(*staged));
}

Expected<int> view(ViewOptions options) {
  if (auto settled = settle_view_options(options); !settled) return tl::unexpected(settled.error());
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  if (options.memory_mb) expect_crashes_without_memory();
  if (options.scene.file.empty()) {
    auto bundled = bundled_scene("city.glb");
    if (!bundled) return tl::unexpected(bundled.error());
    options.scene.file = bundled->string();
  }
  if (options.method.render.light >= 0 || options.scene.edits != stage::SceneEdits{}) {
    auto staged = stage_with_lights(options);
    if (!staged) return tl::unexpected(staged.error());
    options.staged = std::move(*staged);
  }
  return run_window(options);
}

}  // namespace

void add_view_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "view", "Open a window: watch, switch methods, see what each costs");
  const auto options = std::make_shared<ViewOptions>();
  set_examples(command, view_examples);
  add_view_options(command, *options);
  when_chosen(command, [options, &command, &run] {
    settle_quality(command, options->method);
    settle_memory(command, options->memory_mb, options->method);
    options->panel_given = was_given(command, "--panel");
    run = [options] { return view(*options); };
  });
}

}  // namespace tenebra::viewer
