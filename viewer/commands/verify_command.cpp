// tenebra verify: are the masks of a scene the answers of real arithmetic?
#include <fmt/core.h>
#include <limits>
#include <memory>
#include <optional>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "base/machine.h"
#include "base/output_file.h"
#include "base/stopwatch.h"
#include "commands/command.h"
#include "commands/verify_report.h"
#include "options/choices.h"
#include "options/config_file.h"
#include "options/raster_options.h"
#include "render/light_casters.h"
#include "render/shadow_lights.h"
#include "shared/files_apart.h"
#include "shared/render_plan.h"
#include "shared/scene_choice.h"
#include "shell/console.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr std::size_t all_samples = std::numeric_limits<std::size_t>::max();

constexpr const char* verify_examples =
    "Examples:\n"
    "  tenebra verify scenes/city.glb\n"
    "  tenebra verify scenes/city.glb --frames all --samples 20000 --report city.json\n"
    "  tenebra verify kitchen.aff --frames 0:799:50 --variant PreciseSEATP\n"
    "\n"
    "Draws hard shadow masks of all lights as tenebra render does, and asks for each sample what its value\n"
    "must be: by the definition in tenebra/hard_shadows.h, over all triangles that its ray could meet, in\n"
    "doubles with a carried bound of their error and, where these cannot tell, in integers of any length.\n"
    "That code (src/oracle) shares none with the tracer. Visible points, ids and lights are taken as given.\n"
    "Exit code: 0 all are right, 1 failed (one sentence says why), 2 masks are wrong, 130 or 143 stopped by\n"
    "a signal; what was checked until then is reported.";

struct VerifyOptions {
  RenderOptions render;
  std::size_t samples = all_samples;  ///< of each mask
  std::string report;
};

Expected<std::size_t> parse_samples(const std::string& text) {
  if (is_word(text, "all")) return all_samples;
  const auto count = parse_at_least_one(text);
  if (!count) return base::fail("found {}, expected all or a whole number from 1 to 1000000", text);
  return static_cast<std::size_t>(*count);
}

/// What is drawn: exact masks of the pixels' centres and nothing else.
render::RenderSettings mask_settings(const RenderPlan& plan) {
  render::RenderSettings settings = plan.settings;
  settings.shadows = render::ShadowMode::hard;
  settings.samples = render::SampleSource::ids;
  settings.terminator = render::Terminator::flat;
  settings.see_through = SeeThrough::tint;
  settings.ao.mode = AoMode::none;
  settings.antialias = 1;
  return settings;
}

std::vector<render::LogSetting> describe_run(const VerifyOptions& options, const RenderPlan& plan,
                                             const render::FrameRaster& raster) {
  return {
      {"program", "tenebra " TENEBRA_VERSION},
      {"machine", base::machine_description()},
      {"scene", options.render.scene.file},
      {"size", fmt::format("{}x{}", plan.size.width, plan.size.height)},
      {"raster", raster_names(raster).raster},
      {"variant", std::string(variant_name(plan.settings.hard.variant))},
      {"cull", plan.settings.hard.cull_front ? "front" : "none"},
      {"samples of each mask", options.samples == all_samples ? "all" : fmt::format("{}", options.samples)}};
}

/// Draws frame after frame and checks the masks of each.
class Verifier {
public:
  Verifier(const VerifyOptions& options, const RenderPlan& plan) : options_(options), plan_(plan) {}

  Expected<void> run(StopSignals& stop) {
    base::Stopwatch watch;
    auto raster = render::FrameRaster::create(options_.render.raster);
    if (!raster) return tl::unexpected(raster.error());
    render::Renderer renderer = render::Renderer::create(std::move(*raster), plan_.scene);
    verification_.settings = describe_run(options_, plan_, renderer.raster());
    verification_.planned_frames = plan_.frames.size();
    Progress progress(static_cast<int>(plan_.frames.size()), options_.render.quiet);
    for (const PlannedFrame& frame : plan_.frames) {
      const auto checked = check_frame(renderer, frame, stop);
      if (!checked && checked.error().message != "stopped") return checked;
      if (stop.flag().requested()) break;
      progress.show(static_cast<int>(++verification_.frames));
    }
    verification_.seconds = watch.lap_ms() / 1e3;
    return {};
  }

  const Verification& verification() const { return verification_; }

private:
  Expected<void> check_frame(render::Renderer& renderer, const PlannedFrame& planned, StopSignals& stop) {
    const SceneEdits& edits = options_.render.scene.edits;
    evaluate_frame(plan_.scene, plan_.clip, planned.time_s, input_.geometry);
    apply_node_edits(plan_.scene, edits, input_.geometry);
    input_.lights = placed_lights(plan_.scene, edits, plan_.clip, planned.time_s);
    input_.view = view_of(plan_, options_.render.scene, planned.time_s, plan_.size);
    const render::RenderSettings settings = mask_settings(plan_);
    auto drawn = renderer.render_frame(input_, settings, result_, {}, &stop.flag());
    if (!drawn) return drawn;
    compute_visible_points(renderer.triangle_ids(), settings.width, settings.height, input_.view,
                           triangle_view(input_.geometry), points_);
    for (const render::LightMask& mask : result_.masks) {
      for (const render::DrawnLight& light : renderer.drawn_lights())
        if (light.number == mask.light) check_mask(planned.frame, light, mask, settings, stop);
    }
    return {};
  }

  void check_mask(int frame, const render::DrawnLight& light, const render::LightMask& mask,
                  const render::RenderSettings& settings, StopSignals& stop) {
    base::Stopwatch watch;
    std::vector<std::uint8_t> casters;
    const TriangleView triangles = render::casters_of(plan_.scene, input_.geometry, light, casters);
    const auto pixels = oracle::spread_samples(
        points_.triangles, options_.samples,
        static_cast<std::uint64_t>(frame) << 32 | static_cast<std::uint64_t>(mask.light));
    CheckedMask checked{.frame = frame, .light = mask.light, .width = settings.width, .check = {}};
    with_threads(settings.threads, [&] {
      const oracle::ExactShadow exact(input_.view, triangles, render::shadow_light(light.light, light.placed),
                                      settings.hard);
      checked.check = oracle::check_mask(exact, points_, mask.mask.pixels, pixels, &stop.flag());
    });
    checked.check_s = watch.lap_ms() / 1e3;
    verification_.masks.push_back(std::move(checked));
  }

  const VerifyOptions& options_;
  const RenderPlan& plan_;
  render::FrameInput input_;
  render::FrameResult result_;
  VisiblePoints points_;
  Verification verification_;
};

Expected<void> write_report(const std::string& path, const Verification& verification) {
  if (path.empty()) return {};
  return base::write_file(
      path, path.ends_with(".json") ? verification_json(verification) : verification_text(verification));
}

/// That the report may be written, before hours of work.
Expected<void> check_report(const VerifyOptions& options, const RenderPlan& plan) {
  if (options.report.empty()) return {};
  std::vector<std::filesystem::path> inputs = plan.inputs;
  if (!options.render.config.empty()) inputs.emplace_back(options.render.config);
  return check_files_apart(inputs, OutputName{"--report", options.report});
}

Expected<int> verify(const VerifyOptions& options) {
  if (auto checked = check_scene_options(options.render.scene); !checked)
    return tl::unexpected(checked.error());
  StopSignals stop(options.render.timeout_s, StopSignals::Start::at_once);
  const auto plan = plan_render(options.render);
  if (!plan) return tl::unexpected(plan.error());
  if (!options.render.quiet) print_warnings(plan->scene.warnings);
  if (auto apart = check_report(options, *plan); !apart) return tl::unexpected(apart.error());
  stop.be_orderly();
  Verifier verifier(options, *plan);
  if (auto done = verifier.run(stop); !done) return tl::unexpected(done.error());
  const Verification& verification = verifier.verification();
  print_out("{}", verification_text(verification));
  if (auto written = write_report(options.report, verification); !written)
    return tl::unexpected(written.error());
  if (verification.wrong() > 0) return exit_code_of(verification);
  const bool stopped = verification.frames < verification.planned_frames;
  if (stopped)
    print_error("tenebra: stopped after {} of {} frames\n", verification.frames, verification.planned_frames);
  if (stopped) return stop.exit_code();
  if (verification.stats().samples == 0)
    return base::fail("found no sample to check: no light has a mask, or no triangle is seen");
  return 0;
}

}  // namespace

void add_verify_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "verify", "Check the masks of hard shadows against exact arithmetic");
  const auto options = std::make_shared<VerifyOptions>();
  set_examples(command, verify_examples);
  add_scene_options(command, options->render.scene);
  option_of(command, "SCENE").required();
  add_value(command, "--frames", options->render.frames, parse_frame_range,
            "Frames to check; 0:99:10 for every tenth [0, the first]")
      .type_name("A:B[:STEP]|all")
      .excludes(option_of(command, "--time"));
  add_value(command, "--samples", options->samples, parse_samples,
            "Visible points of each mask that are checked, spread over\nthe picture [all]")
      .type_name("N|all");
  add_text(command, "--report", options->report, "The result as a file; with .json for programs")
      .type_name("FILE");
  add_tracer_options(command, options->render.method);
  add_raster_options(command, options->render.raster);
  add_flag(command, "--quiet", options->render.quiet, "No progress and no warnings");
  add_config_option(command);
  when_chosen(command, [options, &run] { run = [options] { return verify(*options); }; });
}

}  // namespace tenebra::viewer
