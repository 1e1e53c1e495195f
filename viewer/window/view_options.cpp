#include "window/view_options.h"

#include "base/fail.h"
#include "options/config_file.h"
#include "options/memory_option.h"
#include "options/raster_options.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

constexpr const char* window_group = "Window";
constexpr const char* compare_group = "Compare and explain";
constexpr const char* output_group = "Output";

constexpr std::array show_choices{
    Choice<CompareView>{"a", CompareView::a}, Choice<CompareView>{"b", CompareView::b},
    Choice<CompareView>{"side", CompareView::side_by_side}, Choice<CompareView>{"wipe", CompareView::wipe},
    Choice<CompareView>{"difference", CompareView::difference}};
constexpr std::array overlay_choices{Choice<Overlay>{"none", Overlay::none},
                                     Choice<Overlay>{"nodes", Overlay::nodes},
                                     Choice<Overlay>{"classes", Overlay::classes}};
constexpr std::array navigate_choices{Choice<CameraMode>{"scene", CameraMode::scene},
                                      Choice<CameraMode>{"orbit", CameraMode::orbit},
                                      Choice<CameraMode>{"fly", CameraMode::fly}};

template <const auto& choices, class Target>
AddedOption add_choice(CLI::App& command, const char* name, Target& target, const char* help) {
  const auto parse = +[](const std::string& text) { return parse_choice(choices, text); };
  return add_value(command, name, target, parse, help).type_name(choice_list(choices, "|"));
}

Expected<double> parse_speed(const std::string& text) {
  const auto speed = parse_time(text);
  if (!speed || *speed < -fastest_speed || *speed > fastest_speed) {
    return base::fail("found {}, expected a speed from -4 to 4", text);
  }
  return speed;
}

Expected<double> parse_preview_budget(const std::string& text) {
  const auto ms = parse_time(text);
  if (!ms || *ms < 0 || *ms > most_preview_ms) {
    return base::fail("found {}, expected milliseconds from 1 to {:g}, or 0 for no previews", text,
                      most_preview_ms);
  }
  return ms;
}

Expected<float> parse_wipe(const std::string& text) {
  const auto part = parse_time(text);
  if (!part || *part < 0 || *part > 1) return base::fail("found {}, expected 0 to 1", text);
  return static_cast<float>(*part);
}

Expected<std::optional<OutputPattern>> parse_numbered(const std::string& text) {
  auto pattern = OutputPattern::parse(text);
  if (!pattern) return tl::unexpected(pattern.error());
  if (!pattern->is_numbered())
    return base::fail("found {}, expected a number in it, like out/%04d.png", text);
  return std::optional<OutputPattern>(std::move(*pattern));
}

/// Slot B from the text of its options, on top of slot A's.
Expected<MethodOptions> parse_method(const std::string& text, const MethodOptions& base) {
  MethodOptions method = base;
  method.quality.reset();               // what it stands for is in the settings
  const auto command = lone_command();  // --help is no method
  add_method_options(*command, method);
  if (auto parsed = parse_arguments(*command, text); !parsed)
    return base::fail("--compare: {}", parsed.error().message);
  settle_quality(*command, method);
  if (auto checked = check_method_settings(method); !checked)
    return base::fail("--compare: {}", checked.error().message);
  return method;
}

void add_window_options(CLI::App& command, ViewOptions& options) {
  const auto group = [](AddedOption option) { option.group(window_group); };
  group(add_value(command, "--window", options.window, parse_size,
                  "Size of the window [as it was left, or 1280x720]")
            .type_name("WxH"));
  group(add_flag(command, "--panel,!--no-panel", options.panel,
                 "Show the panel on the right [as it was left, or yes]"));
  group(add_text(command, "--settings", options.settings,
                 "Where the window's size and the last scenes are kept, or\nnone [viewer.json in "
                 "$XDG_CONFIG_HOME/tenebra]")
            .type_name("FILE|none"));
  group(add_flag(command, "--play", options.play, "Start playing"));
  group(add_value(command, "--speed", options.speed, parse_speed, "Speed of playing; below 0: backwards [1]")
            .type_name("-4..4"));
  group(add_flag(command, "--loop,!--no-loop", options.loop, "Start again at the end [yes]"));
  group(add_flag(command, "--fixed-step", options.fixed_step,
                 "Show every frame, however long it takes, instead of\n"
                 "following the clock"));
  group(
      add_value(
          command, "--preview-budget", options.preview_ms, parse_preview_budget,
          "Time for a picture while you drag or hold a key, in\nmilliseconds; pictures that take longer are "
          "shown as\npreviews first, and refined when you stop. 0: no previews\n[80]")
          .type_name("MS"));
  group(add_choice<navigate_choices>(
      command, "--navigate", options.navigate,
      "Camera: the scene's, or one that orbits or flies\n[scene; orbit with --eye]"));
}

void add_compare_options(CLI::App& command, ViewOptions& options) {
  const auto group = [](AddedOption option) { option.group(compare_group); };
  group(add_text(command, "--compare", options.compare_text,
                 "--compare=\"OPTIONS\": a second method, B, which is the\n"
                 "first (A) with these shadow or ao options")
            .type_name("TEXT"));
  group(add_choice<show_choices>(command, "--show", options.show, "How A and B are shown [wipe]"));
  group(add_value(command, "--wipe", options.wipe, parse_wipe, "Place of the wipe, 0 left to 1 right [0.5]")
            .type_name("0..1"));
  group(add_choice<overlay_choices>(command, "--overlay", options.overlay,
                                    "nodes: how many node tests each pixel took; classes: how\nsoft shadows "
                                    "found each pixel's answer [none]"));
}

void add_output_options(CLI::App& command, ViewOptions& options) {
  const auto group = [](AddedOption option) { option.group(output_group); };
  options.shots = OutputPattern::parse("tenebra_%04d.png").value();
  group(
      add_value(command, "--shots", options.shots, parse_numbered, "Names of screenshots [tenebra_%04d.png]")
          .type_name("FILE.png"));
  group(add_value(command, "--record", options.record, parse_numbered,
                  "Play the animation once, frame by frame, and write every\n"
                  "picture; %04d is the frame")
            .type_name("FILE.png"));
  group(add_text(command, "--log", options.log,
                 "Log: times and counts of each frame, as tenebra render\nwrites it")
            .type_name("FILE.csv"));
  group(
      add_value(command, "--exit-after", options.exit_after, parse_count, "Quit after N pictures [0: never]")
          .type_name("N"));
  group(add_text(command, "--report", options.report,
                 "File that says what happens, for scripts: one JSON object\n"
                 "per line")
            .type_name("FILE"));
  group(add_flag(command, "--gl-debug", options.gl_debug,
                 "Use OpenGL debug contexts; their messages go to the report"));
  for (const AddedOption option : add_raster_options(command, options.raster)) group(option);
  group(add_memory_option(
      command, options.memory_mb,
      "Memory for the whole program, in MB; a picture or a scene that needs more is refused "
      "with a message [what the system has]"));
}

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& options) {
  add_scene_options(command, options.scene);
  add_method_options(command, options.method);
  add_window_options(command, options);
  add_compare_options(command, options);
  add_output_options(command, options);
  add_config_option(command);
}

Expected<void> settle_view_options(ViewOptions& options) {
  if (auto checked = check_scene_settings(options.scene); !checked) return checked;
  if (auto checked = check_method_settings(options.method); !checked) return checked;
  if (options.compare_text) {
    auto method = parse_method(*options.compare_text, options.method);
    if (!method) return tl::unexpected(method.error());
    options.compare = std::move(*method);
  }
  options.scene.meter_exposure =
      options.method.auto_exposure || (options.compare && options.compare->auto_exposure);
  options.scene.exposure_given =
      options.method.exposure_given && (!options.compare || options.compare->exposure_given);
  options.scene.emissive_lights = makes_emissive_lights(options.method);
  if (options.scene.eye && options.navigate == CameraMode::scene) options.navigate = CameraMode::orbit;
  if (options.record) {
    options.play = options.fixed_step = true;
    options.loop = false;
    if (auto prepared = options.record->prepare_folder(); !prepared) return prepared;
  }
  return {};
}

}  // namespace tenebra::viewer
