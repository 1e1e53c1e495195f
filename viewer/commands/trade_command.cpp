// tenebra trade: what time buys on this scene and this machine.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/fail.h"
#include "base/machine.h"
#include "commands/command.h"
#include "io/output_file.h"
#include "options/config_file.h"
#include "options/memory_option.h"
#include "options/method_arguments.h"
#include "options/raster_options.h"
#include "options/scene_arguments.h"
#include "options/settings_names.h"
#include "shared/files_apart.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"
#include "trade/trade_choice.h"
#include "trade/trade_page.h"

namespace tenebra::viewer {
namespace {

constexpr const char* trade_examples =
    "Examples:\n"
    "  tenebra trade scenes/court.glb -o court.html\n"
    "      which settings are worth having, and what their errors look like\n"
    "  tenebra trade scenes/city.glb --ao adaptive --budget 100\n"
    "      the most exact setting whose frame takes 100 ms, at most a tenth more\n"
    "  tenebra trade room.glb --frames 0:299:60 --size 1920x1080 --error 1 --json\n"
    "      the quickest setting that is off by at most 1 level of 255\n"
    "\n"
    "Tries values of --antialias, --soft-error (where area lights shine) and --ao-error (with --ao "
    "adaptive); those\n"
    "that are given stay as they are. Each is varied alone on one frame; from that all combinations are "
    "predicted,\n"
    "and the promising ones are drawn by themselves on all frames. Errors are RMS over the whole picture as "
    "it\n"
    "is shown, in levels of 255, against the finest setting: 16 samples per pixel, exact soft shadows, "
    "occlusion to\n"
    "0.5/255. Hard shadows are exact in all of them. Times are medians on this machine with everything "
    "built; run\n"
    "nothing else meanwhile.\n"
    "Exit code: 0 done, 1 failed or nothing fits (one sentence says why), 124 the time of --timeout is up, "
    "129, 130 or\n"
    "143 stopped by a signal.";

constexpr int frames_without_option = 3, frames_not_tried = 16;

struct TradeOptions {
  RenderOptions render;
  std::optional<double> budget_ms;
  std::optional<double> error;
  int repeats = 3;
  std::string output;
  bool json = false;
  bool shadows_given = false;
  TradeGiven given;
};

/// Whether some light has an area, or gets one.
bool has_area_light(const RenderPlan& plan, const RenderOptions& options) {
  const std::vector<Light> lights =
      stage::lights_of(plan.staged->scene, options.scene.edits, plan.staged->light_has_units);
  const render::AreaLightSettings& area = plan.settings.area_lights;
  const auto own = [](const auto& list, std::size_t i) { return i < list.size() && list[i].has_value(); };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const float sun_deg =
        own(area.own_sun_deg, i) ? *area.own_sun_deg[i] : area.sun_deg.value_or(light.diameter_deg);
    if (light.type == LightType::area_rect || light.type == LightType::area_disk || own(area.own_size_m, i) ||
        (light.type == LightType::directional && sun_deg > 0))
      return true;
  }
  return area.size.x > 0 || area.emissive_quads;
}

/// Frames in the middle of `parts` equal parts of `count` frames from `first` on.
std::vector<PlannedFrame> spread_frames(const RenderPlan& plan, int first, int count, int parts) {
  const int wanted = std::min(count, parts);
  std::vector<PlannedFrame> frames;
  for (int i = 0; i < wanted; ++i) {
    const int frame = first + static_cast<int>((2LL * i + 1) * count / (2LL * wanted));
    frames.push_back({frame, plan.staged->time_of_frame(frame)});
  }
  return frames;
}

/// The plan with frames and shadows chosen where the user left them open.
Expected<RenderPlan> plan_trade(TradeOptions& options) {
  if (auto checked = check_scene_settings(options.render.scene); !checked)
    return tl::unexpected(checked.error());
  if (auto checked = check_method_settings(options.render.method); !checked)
    return tl::unexpected(checked.error());
  auto plan = plan_render(options.render);
  if (!plan) return plan;
  if (!options.render.frames && !options.render.scene.time_s)
    plan->frames = spread_frames(*plan, 0, plan->staged->frames(), frames_without_option);
  if (!options.shadows_given && has_area_light(*plan, options.render))
    plan->settings.shadows = options.render.method.render.shadows = render::ShadowMode::soft;
  return plan;
}

TradeHeading heading_of(const TradeOptions& options, const RenderPlan& plan, const TradeAxes& axes) {
  MethodOptions shared = options.render.method;
  if (axes.antialias.size() > 1) shared.render.antialias = standard_antialias;
  if (axes.soft_errors.size() > 1) shared.render.soft.error_255 = SoftShadowConfig{}.error_255;
  if (axes.ao_errors.size() > 1) shared.render.ao.error_255 = AoConfig{}.error_255;
  const SceneOptions& scene = options.render.scene;
  std::string arguments = dressing_arguments(scene) + view_arguments(scene) + method_arguments(shared);
  for (const EditOption& edit : edit_options(scene.edits))
    arguments += fmt::format("{}{} {}", arguments.empty() || arguments.ends_with(' ') ? "" : " ", edit.name,
                             shell_word(edit.value));
  while (arguments.ends_with(' ')) arguments.pop_back();
  TradeHeading heading;
  heading.scene = options.render.scene.file;
  heading.machine = base::machine_description();
  heading.command = fmt::format("tenebra render {}{}{}", shell_word(heading.scene),
                                arguments.empty() ? "" : " ", arguments);
  heading.width = plan.settings.width, heading.height = plan.settings.height;
  heading.threads = plan.settings.threads;
  return heading;
}

Expected<const TradedSetting*> setting_within_budget(double budget_ms, const TradeResult& result,
                                                     const TimeSetting& time) {
  const auto found = within_budget(result, budget_ms, time);
  if (!found) return tl::unexpected(found.error());
  if (found->setting == nullptr)
    return base::fail("--budget {:g} ms: nothing is as quick, the quickest setting takes {:.1f} ms",
                      budget_ms, found->ms);
  return found->setting;
}

Expected<const TradedSetting*> setting_within_error(double error, const TradeResult& result) {
  if (const TradedSetting* found = within_error(result, error)) return found;
  double least = HUGE_VAL;
  for (const TradedSetting& setting : result.measured)
    least = std::min(least, promised_error(result, setting));
  return base::fail("--error {:g}: found none as exact, the most exact setting tried is off by {:.2f}", error,
                    least);
}

/// The front, and all that was measured.
Expected<void> print_result(const TradeOptions& options, const TradeHeading& heading,
                            const TradeResult& result) {
  if (options.json) {
    print_out("{}", trade_json(heading, result));
  } else {
    print_out("{}, {}x{} pixels, {} frames, {}\n{}", heading.scene, heading.width, heading.height,
              result.frames.size(), heading.machine, trade_table(result));
  }
  if (options.output.empty()) return {};
  const auto page = trade_page(heading, result);
  if (!page) return tl::unexpected(page.error());
  return io::write_file(options.output, *page);
}

void print_command(const TradeOptions& options, const TradeHeading& heading, const std::string& words) {
  const std::string line = fmt::format("{}{}{}\n", heading.command, words.empty() ? "" : " ", words);
  if (options.json)
    print_error("{}", line);
  else
    print_out("\n{}", line);
}

/// Frames between the first and the last that the user asks for, or of all.
std::vector<PlannedFrame> more_frames(const RenderPlan& plan, const TradeOptions& options) {
  const bool given = options.render.frames.has_value();
  const int first = given ? plan.frames.front().frame : 0,
            count = given ? plan.frames.back().frame - first : plan.staged->frames();
  return spread_frames(plan, first, count, frames_not_tried);
}

/// It refers to the arguments.
TradeRequest request_of(const TradeOptions& options, const RenderPlan& plan) {
  TradeRequest request;
  request.scene = plan.staged;
  request.clip = plan.staged->clip;
  request.frames = plan.frames;
  if (plan.frames.size() > 1) request.more_frames = more_frames(plan, options);
  request.settings = plan.settings;
  request.raster = options.render.raster;
  request.edits = options.render.scene.edits;
  request.view = [&](double time_s) { return plan.rays(time_s); };
  request.axes = axes_of(plan.settings, options.given);
  request.repeats = options.repeats;
  if (options.budget_ms) request.aim_s *= 2.0 / 3;  // the rest is for timing those that may fit
  return request;
}

/// What --budget or --error asks for.
Expected<const TradedSetting*> choose(const TradeOptions& options, const TradeRequest& request,
                                      const TradeResult& result, const StopFlag& stop) {
  if (options.error) return setting_within_error(*options.error, result);
  Progress progress(1, options.render.quiet);
  return setting_within_budget(*options.budget_ms, result, [&](const TradePoint& point) {
    return time_setting(
        request, point, [&](double done) { progress.show_building("timing what may fit", done); }, stop);
  });
}

Expected<void> search(const TradeOptions& options, const RenderPlan& plan, const StopFlag& stop) {
  const TradeRequest request = request_of(options, plan);
  const TradeHeading heading = heading_of(options, plan, request.axes);
  const auto result = [&] {
    Progress progress(1, options.render.quiet);
    return run_trade(
        request, [&](double done) { progress.show_building("trying settings", done); }, stop);
  }();
  if (!result) return tl::unexpected(result.error());
  if (auto printed = print_result(options, heading, *result); !printed) return printed;
  if (!options.budget_ms && !options.error) return {};
  const auto chosen = choose(options, request, *result, stop);
  if (!chosen) return tl::unexpected(chosen.error());
  print_command(options, heading, options_of(result->axes, (*chosen)->point.setting));
  return {};
}

Expected<int> trade(TradeOptions& options) {
  StopSignals stop(options.render.timeout_s, StopSignals::Start::at_once);
  if (auto limited = limit_memory(options.render.memory_mb); !limited) return tl::unexpected(limited.error());
  const auto plan = plan_trade(options);
  if (!plan) return tl::unexpected(plan.error());
  if (!options.render.quiet) print_warnings(plan->staged->scene.warnings);
  if (!options.output.empty()) {
    const std::filesystem::path folder = std::filesystem::path(options.output).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
      return base::fail("cannot write {}: {} is not a folder", options.output, folder.string());
    std::vector<std::filesystem::path> inputs = plan->staged->inputs;
    if (!options.render.config.empty()) inputs.emplace_back(options.render.config);
    if (auto apart = check_files_apart(inputs, OutputName{"-o", options.output}); !apart)
      return tl::unexpected(apart.error());
  }
  stop.be_orderly();
  const auto found = search(options, *plan, stop.flag());
  if (is_stop(found)) {
    print_error("tenebra: stopped before all settings were tried\n");
    return stop.exit_code();
  }
  if (!found) return tl::unexpected(found.error());
  return 0;
}

}  // namespace

void add_trade_command(CLI::App& program, Run& run) {
  CLI::App& command = add_command(program, "trade", "Find which settings are worth their time on a scene");
  const auto options = std::make_shared<TradeOptions>();
  set_examples(command, trade_examples);
  add_value(command, "--frames", options->render.frames, parse_frame_range,
            "Frames to try; 0:99:10 for every tenth [three, spread out]")
      .type_name("A:B[:STEP]|all");
  add_value(command, "--budget", options->budget_ms, parse_positive,
            "Also print the most exact setting whose frame takes this\n"
            "many milliseconds, at most a tenth more, timed on frames\n"
            "that were not tried")
      .type_name("MS");
  add_value(command, "--error", options->error, parse_positive,
            "Also print the quickest setting that is off by at most\n"
            "this many levels of 255, RMS, in every frame; a margin\n"
            "covers the frames that were not tried")
      .type_name("E")
      .excludes(option_of(command, "--budget"));
  add_value(command, "--repeats", options->repeats, parse_at_least_one,
            "How often each frame is drawn, slow ones less often;\n"
            "medians count [3]")
      .type_name("N");
  add_text(command, "-o,--output", options->output, "Page to write: plot, table, what the errors look like")
      .type_name("FILE.html");
  add_flag(command, "--json", options->json, "Print JSON: all that was measured");
  add_value(command, "--timeout", options->render.timeout_s, parse_positive,
            "Stop after this many seconds, as Ctrl-C does")
      .type_name("S");
  add_memory_option(command, options->render.memory_mb);
  add_flag(command, "--quiet", options->render.quiet, "No progress and no warnings");
  add_raster_options(command, options->render.raster);
  add_scene_options(command, options->render.scene);
  option_of(command, "SCENE").required();
  add_method_options(command, options->render.method);
  add_config_option(command);
  when_chosen(command, [options, &command, &run] {
    settle_quality(command, options->render.method);
    settle_memory(command, options->render.memory_mb, options->render.method);
    const bool quality = options->render.method.quality.has_value();
    options->shadows_given = was_given(command, "--shadows");
    options->given = {was_given(command, "--antialias"), quality || was_given(command, "--soft-error"),
                      quality || was_given(command, "--ao-error")};
    options->render.config = config_file_of(command);
    run = [options] { return trade(*options); };
  });
}

}  // namespace tenebra::viewer
