// tenebra verify: are the shadows of a scene the answers of real arithmetic?
#include <fmt/core.h>
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "base/machine.h"
#include "base/stopwatch.h"
#include "commands/command.h"
#include "commands/file_numbers.h"
#include "commands/verify_report.h"
#include "io/output_file.h"
#include "options/config_file.h"
#include "options/memory_option.h"
#include "options/raster_options.h"
#include "options/settings_names.h"
#include "render/light_casters.h"
#include "render/shadow_lights.h"
#include "shared/files_apart.h"
#include "shared/render_plan.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr std::size_t all_samples = std::numeric_limits<std::size_t>::max();
constexpr std::size_t usual_fractions = 1000;  // of a light in a frame
/// How far a visible fraction may be off: tenebra/soft_shadows.h.
constexpr double promised_error = 0.1 / 255;

constexpr const char* verify_examples =
    "Examples:\n"
    "  tenebra verify scenes/city.glb\n"
    "  tenebra verify scenes/city.glb --frames all --samples 20000 --report city.json\n"
    "  tenebra verify kitchen.aff --frames 0:799:50 --paper variant=PreciseSEATP\n"
    "  tenebra verify scenes/court.glb --shadows soft --light-size 0.5 --samples 5000\n"
    "\n"
    "Draws hard shadow masks of all lights as tenebra render does, and computes what each sample's value "
    "must\n"
    "be: by the definition in tenebra/hard_shadows.h, over all triangles that its ray could meet, in "
    "doubles\n"
    "with a bound on their error and, where that leaves it open, in integers of any length. This code\n"
    "(src/oracle) shares nothing with the tracer. Visible points, ids and lights are taken as given. Where\n"
    "floats cannot hold what the file says (coordinates far from the origin), hard masks are compared with "
    "the\n"
    "file's own numbers, in double.\n"
    "With --shadows soft the visible fractions of lights with an area are checked: which triangles hide what "
    "is\n"
    "found exactly, the area that they leave with a bound. A fraction may be off by as much as is promised:\n"
    "0.1/255. The time of a sample grows with the square of its occluders: those with more than 1000 are\n"
    "skipped, and counted.\n"
    "Exit code: 0 all are right, 1 failed (one sentence says why), 2 some are wrong, 130 or 143 stopped by\n"
    "a signal; what was checked until then is reported.";

struct VerifyOptions {
  RenderOptions render;
  std::optional<std::size_t> samples;  ///< of each mask; not given: all, and `usual_fractions`
  std::string report;
};

Expected<std::size_t> parse_samples(const std::string& text) {
  if (is_word(text, "all")) return all_samples;
  const auto count = parse_at_least_one(text);
  if (!count) return base::fail("found {}, expected all or a whole number from 1 to 1000000", text);
  return static_cast<std::size_t>(*count);
}

/// What is drawn: exact shadows of the pixels' centres and nothing else.
render::RenderSettings checked_settings(const RenderPlan& plan) {
  render::RenderSettings settings = plan.settings;
  settings.samples = render::SampleSource::ids;
  settings.terminator = render::Terminator::flat;
  settings.see_through = SeeThrough::tint;
  settings.ao.mode = AoMode::none;
  settings.antialias = 1;
  return settings;
}

std::string counted(std::size_t samples) {
  return samples == all_samples ? "all" : fmt::format("{}", samples);
}

std::vector<render::LogSetting> describe_run(const VerifyOptions& options, const RenderPlan& plan,
                                             const render::FrameRaster& raster) {
  std::vector<render::LogSetting> run{
      {"program", "tenebra " TENEBRA_VERSION},
      {"machine", base::machine_description()},
      {"scene", options.render.scene.file},
      {"size", fmt::format("{}x{}", plan.settings.width, plan.settings.height)},
      {"raster", raster_names(raster).raster},
      {"variant", std::string(variant_name(plan.settings.hard.variant))},
      {"cull", plan.settings.hard.cull_front ? "front" : "none"},
      {"samples of each mask", counted(options.samples.value_or(all_samples))}};
  if (plan.settings.shadows != render::ShadowMode::soft) return run;
  run.push_back({"samples of each light with an area", counted(options.samples.value_or(usual_fractions))});
  run.push_back({"soft-solver", choice_name(solver_choices, plan.settings.soft.solver)});
  return run;
}

/// Draws frame after frame and checks the masks of each.
class Verifier {
public:
  Verifier(const VerifyOptions& options, const RenderPlan& plan) : options_(options), plan_(plan) {}

  Expected<void> run(StopSignals& stop) {
    base::Stopwatch watch;
    auto session = open_session(plan_, options_.render);
    if (!session) return tl::unexpected(session.error());
    verification_.settings = describe_run(options_, plan_, session->renderer().raster());
    verification_.planned_frames = plan_.frames.size();
    Progress progress(static_cast<int>(plan_.frames.size()), options_.render.quiet);
    for (const PlannedFrame& frame : plan_.frames) {
      const auto checked = check_frame(*session, frame, stop);
      if (!checked && !is_stop(checked)) return checked;
      if (stop.flag().requested()) break;
      progress.show(static_cast<int>(++verification_.frames));
    }
    verification_.seconds = watch.lap_ms() / 1e3;
    return {};
  }

  const Verification& verification() const { return verification_; }

private:
  Expected<void> check_frame(session::Session& session, const PlannedFrame& planned, StopSignals& stop) {
    session.place(planned.time_s, plan_.rays(planned.time_s));
    const render::RenderSettings settings = checked_settings(plan_);
    auto drawn = session.draw(settings, result_, {}, &stop.flag());
    if (!drawn) return drawn;
    const render::FrameInput& input = session.placed();
    compute_visible_points(session.renderer().triangle_ids(), settings.width, settings.height, input.view,
                           triangle_view(input.geometry), points_);
    file_ = file_numbers(*plan_.staged, planned.time_s, input, points_);
    if (file_) verification_.rounding_m = std::max(verification_.rounding_m.value_or(0), file_->rounding_m);
    for (const render::LightMask& mask : result_.masks) {
      for (const render::DrawnLight& light : session.renderer().drawn_lights())
        if (light.number == mask.light) check_light(input, planned, light, mask, settings, stop);
    }
    return {};
  }

  void check_light(const render::FrameInput& input, const PlannedFrame& planned,
                   const render::DrawnLight& light, const render::LightMask& mask,
                   const render::RenderSettings& settings, StopSignals& stop) {
    std::vector<std::uint8_t> casters;
    const TriangleView triangles = render::casters_of(plan_.staged->scene, input.geometry, light, casters);
    const auto pixels = oracle::spread_samples(
        points_.triangles, options_.samples.value_or(light.area ? usual_fractions : all_samples),
        static_cast<std::uint64_t>(planned.frame) << 32 | static_cast<std::uint64_t>(mask.light));
    with_threads(settings.threads, [&] {
      if (light.area)
        check_fractions(input.view, planned.frame, light, triangles, mask, pixels, stop);
      else
        check_mask(input.view, planned, light, triangles, mask, pixels, stop);
    });
  }

  void check_mask(const ViewRays& view, const PlannedFrame& planned, const render::DrawnLight& light,
                  const TriangleView& triangles, const render::LightMask& mask,
                  const std::vector<std::size_t>& pixels, StopSignals& stop) {
    base::Stopwatch watch;
    const ShadowLight drawn = render::shadow_light(light.light, light.placed);
    const oracle::ExactShadow exact =
        file_ ? oracle::ExactShadow(file_->view, {triangles, file_->positions},
                                    file_->light(*plan_.staged, planned.time_s, light.placed, drawn),
                                    plan_.settings.hard)
              : oracle::ExactShadow(view, triangles, drawn, plan_.settings.hard);
    CheckedMask checked{
        .frame = planned.frame, .light = mask.light, .width = plan_.settings.width, .check = {}};
    checked.check =
        oracle::check_mask(exact, file_ ? file_->points : points_, mask.mask.pixels, pixels, &stop.flag());
    checked.check_s = watch.lap_ms() / 1e3;
    verification_.masks.push_back(std::move(checked));
  }

  void check_fractions(const ViewRays& view, int frame, const render::DrawnLight& light,
                       const TriangleView& triangles, const render::LightMask& mask,
                       const std::vector<std::size_t>& pixels, StopSignals& stop) {
    base::Stopwatch watch;
    const oracle::ExactSoft front(view, triangles, *light.area);
    std::optional<oracle::ExactSoft> back;
    if (render::shines_behind(light)) back.emplace(view, triangles, *light.back);
    CheckedFractions checked{.frame = frame,
                             .light = mask.light,
                             .width = plan_.settings.width,
                             .promise = promised_error,
                             .check = {}};
    const oracle::FractionRequest request{
        .front = &front, .back = back ? &*back : nullptr, .promise = checked.promise};
    checked.check =
        oracle::check_fractions(request, points_, mask.visible_fraction.pixels, pixels, &stop.flag());
    checked.check_s = watch.lap_ms() / 1e3;
    verification_.fractions.push_back(std::move(checked));
  }

  const VerifyOptions& options_;
  const RenderPlan& plan_;
  render::FrameResult result_;
  VisiblePoints points_;
  std::optional<FileNumbers> file_;  ///< of the frame, where floats are not fine
  Verification verification_;
};

Expected<void> write_report(const std::string& path, const Verification& verification) {
  if (path.empty()) return {};
  return io::write_file(
      path, path.ends_with(".json") ? verification_json(verification) : verification_text(verification));
}

/// Fails before hours of work if the report cannot be written or would replace an input.
Expected<void> check_report(const VerifyOptions& options, const RenderPlan& plan) {
  if (options.report.empty()) return {};
  std::vector<std::filesystem::path> inputs = plan.staged->inputs;
  if (!options.render.config.empty()) inputs.emplace_back(options.render.config);
  return check_files_apart(inputs, OutputName{"--report", options.report});
}

Expected<int> verify(const VerifyOptions& options) {
  if (auto checked = check_scene_settings(options.render.scene); !checked)
    return tl::unexpected(checked.error());
  if (auto limited = limit_memory(options.render.memory_mb); !limited) return tl::unexpected(limited.error());
  StopSignals stop(options.render.timeout_s, StopSignals::Start::at_once);
  RenderOptions render = options.render;
  render.scene.import.keep_unrounded = true;
  render.scene.shows = false;
  const auto plan = plan_render(render);
  if (!plan) return tl::unexpected(plan.error());
  if (plan->settings.shadows == render::ShadowMode::none)
    return base::fail(
        "found --shadows none, expected hard or soft: without shadows there is nothing to check");
  if (!options.render.quiet) print_warnings(plan->staged->scene.warnings);
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
  const std::uint64_t samples = verification.stats().samples + verification.fraction_stats().samples;
  if (const std::uint64_t skipped = verification.fraction_stats().skipped; samples == 0 && skipped > 0)
    return base::fail("found no sample to check: all {} were skipped", skipped);
  if (samples == 0)
    return base::fail("found no sample to check: no light has a mask, or no triangle is seen");
  return 0;
}

}  // namespace

void add_verify_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "verify", "Check shadows, sample by sample, against exact arithmetic");
  const auto options = std::make_shared<VerifyOptions>();
  set_examples(command, verify_examples);
  add_scene_options(command, options->render.scene);
  option_of(command, "SCENE").required();
  add_value(command, "--frames", options->render.frames, parse_frame_range,
            "Frames to check; 0:99:10 for every tenth [0, the first]")
      .type_name("A:B[:STEP]|all")
      .excludes(option_of(command, "--time"));
  add_value(command, "--samples", options->samples, parse_samples,
            "How many visible points of each mask to check, spread over\n"
            "the picture [all; 1000 for a light with an area]")
      .type_name("N|all");
  add_text(command, "--report", options->report, "File to write the result to; .json for programs")
      .type_name("FILE");
  add_tracer_options(command, options->render.method);
  add_raster_options(command, options->render.raster);
  add_memory_option(command, options->render.memory_mb);
  add_flag(command, "--quiet", options->render.quiet, "No progress and no warnings");
  add_config_option(command);
  when_chosen(command, [options, &run] { run = [options] { return verify(*options); }; });
}

}  // namespace tenebra::viewer
