// tenebra sun: how long the sun reaches faces, the ground or points.
#include <algorithm>
#include <cmath>
#include <memory>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "base/stopwatch.h"
#include "commands/command.h"
#include "io/output_file.h"
#include "options/sun_options.h"
#include "session/session.h"
#include "shared/files_apart.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"
#include "sun/hours_model.h"
#include "sun/plan.h"
#include "sun/sky.h"

namespace tenebra::viewer {
namespace {

constexpr const char* sun_examples =
    "Examples:\n"
    "  tenebra sun house.obj --up-axis z --place 48.14,11.58 --day 2026-06-21 -o hours.glb --csv hours.csv\n"
    "      hours of sun on each face as colours, and as a table with the first and the last sun\n"
    "  tenebra sun park.glb --place 48.14,11.58 --days 2026-03-01:2026-09-30:7 --ground 0 --png "
    "park.png\n"
    "      a plan of a half year's hours on the ground, every seventh day computed\n"
    "  tenebra sun house.obj --up-axis z --epw town.epw --sky tregenza --season tree=4:10 -o light.glb\n"
    "      a year's light on each face in kWh/m2, direct and of the sky, behind a tree without leaves in "
    "winter\n"
    "  tenebra sun house.glb --suns sky.csv --points windows.csv --json windows.json\n"
    "      the weights of the suns that each point sees\n"
    "\n"
    "Exact: no bias, and nothing between a point and the sun is missed. Hours are those of an open, flat "
    "horizon, of\n"
    "the scene's triangles and of nothing else: no clouds, no reflected light, no hills beyond the file. "
    "See-through\n"
    "materials dim by their tint's luminance; --no-cast NAME takes nodes out. Times are those of suns: each "
    "stands "
    "for\n"
    "--step minutes around it.\n"
    "Exit code: 0 done, 1 failed (one sentence says why), 124 the time of --timeout is up, 129, 130 or 143 "
    "stopped\n"
    "by a signal; files are then whole or absent.";

/// A scene of one instant.
struct SunScene {
  session::StagedScene staged;
  render::FrameInput input;
};

Expected<SunScene> stage_for_sun(const SunOptions& options) {
  SceneOptions of_scene = options.scene;
  of_scene.exposure_given = true, of_scene.shows = false;
  of_scene.sky = stage::Sky::none;
  auto staged = session::stage_scene(of_scene, session::Staging::for_light);
  if (!staged) return tl::unexpected(staged.error());
  SunScene scene{std::move(*staged), {}};
  const double time_s = options.scene.time_s.value_or(scene.staged.time_of_frame(0));
  session::evaluate(scene.staged.scene, options.scene.edits, scene.staged.clip, time_s, scene.input);
  cast_see_through(options.method.render.see_through, scene.input.geometry);
  return scene;
}

Expected<sun::Suns> find_suns(const SunOptions& options, const FileFrame& frame) {
  if (!options.suns.empty()) return sun::read_suns(options.suns, frame, options.north_deg);
  const auto air = options.refraction ? sun::Refraction::standard : sun::Refraction::none;
  if (options.weather.empty())
    return sun::suns_of({*options.place, std::get<sun::Days>(*options.days), options.step_min.value_or(10),
                         options.zone_min.value_or(0), options.north_deg, air});
  const auto weather = sun::read_weather(options.weather);
  if (!weather) return tl::unexpected(weather.error());
  if (weather->missing > 0 && !options.quiet)
    print_error(
        "note: {} hours of the weather file lack direct light, diffuse light or both; what is missing counts "
        "as 0\n",
        weather->missing);
  sun::WeatherTimes times{{}, options.step_min.value_or(60), options.north_deg, air};
  if (options.days) times.days = std::get<sun::Season>(*options.days);
  auto suns = sun::suns_of(*weather, times);
  if (suns && suns->diffuse_wh_m2.empty())
    return base::fail("{}: found no hour of these --days, expected some that the file has", options.weather);
  return suns;
}

Expected<sun::Receivers> find_receivers(const SunOptions& options, const SunScene& scene) {
  const FrameGeometry& frame = scene.input.geometry;
  const FileFrame& file = scene.staged.scene.frame;
  if (!options.points.empty()) return sun::read_receivers(options.points, file);
  if (options.ground) return sun::ground_receivers(frame, file, *options.ground, options.cell_m);
  return sun::face_receivers(scene.staged.scene, frame, options.faces);
}

/// What a user should know of the suns and the scene.
void print_sun_notes(const SunOptions& options, const sun::Suns& suns) {
  if (suns.list.empty()) print_error("note: no sun stands above the horizon, so there are no hours\n");
  if (!suns.timed() && suns.below > 0)
    print_error("note: {} suns below the horizon do not count\n", suns.below);
  if (suns.lost_wh_m2 > 0)
    print_error(
        "note: {:.3g} kWh/m2 of the direct light come while the sun is below the horizon and do not count\n",
        suns.lost_wh_m2 / 1e3);
  constexpr double far_deg = 45;  // three hours
  if (options.place && !options.zone_min && std::abs(options.place->longitude_deg) > far_deg)
    print_error(
        "note: days and times are UTC, where a day here begins {:.0f} hours off midnight; --zone +HH:MM "
        "gives others\n",
        std::abs(options.place->longitude_deg) / 15);
}

bool spans_months(const sun::Suns& suns) {
  return suns.timed() && std::ranges::any_of(suns.list, [&](const sun::Sun& s) {
           return s.month != suns.list.front().month;
         });
}

struct Counted {
  sun::SunHours hours;
  std::optional<sun::SkyLight> sky;
};

Expected<Counted> count_hours(const SunOptions& options, const SunScene& scene,
                              const sun::Receivers& receivers, const sun::Suns& suns, const StopFlag& stop) {
  const sun::SeasonalScene asked{scene.staged.scene, scene.input.geometry, options.seasonal};
  const render::RenderSettings settings = render_settings(options.method, {}, {});
  const sun::HoursConfig config{.disc_deg = options.disc_deg,
                                .months = spans_months(suns),
                                .hard = settings.hard,
                                .soft = settings.soft};
  Progress line(1, options.quiet);
  const auto show = [&](const char* what) {
    return [&line, what](double done) { line.show_building(what, done); };
  };
  Expected<Counted> counted;
  with_threads(settings.threads, [&] {
    auto hours = sun::hours_of(asked, receivers, suns, config, &stop, show("sun"));
    if (!hours) return void(counted = tl::unexpected(hours.error()));
    counted->hours = std::move(*hours);
    if (options.sky_parts == 0) return;
    auto sky = sun::sky_of(asked, receivers, suns, sun::sky_patches(options.sky_parts, options.north_deg),
                           config, &stop, show("sky"));
    if (!sky) return void(counted = tl::unexpected(sky.error()));
    counted->sky = std::move(*sky);
  });
  return counted;
}

sun::ColourScale chosen_scale(const SunOptions& options, const sun::Study& study) {
  return options.full > 0 ? sun::ColourScale{options.full} : sun::scale_of(study);
}

Expected<void> write_model(const SunOptions& options, const sun::Study& study) {
  const auto model = sun::model_of(study, chosen_scale(options, study));
  if (!model) return tl::unexpected(model.error());
  io::remove_stale_temporaries(std::filesystem::path(options.model).parent_path());
  const auto losses = formats::export_glb(model->scene, options.model, 30, model->additions);
  if (!losses) return tl::unexpected(losses.error());
  return {};
}

Expected<void> write_plan(const SunOptions& options, const sun::Study& study) {
  return io::write_png(options.plan, sun::plan_of(study, chosen_scale(options, study)));
}

Expected<void> write_hours(const SunOptions& options, const sun::Study& study) {
  using Make = Expected<void> (*)(const SunOptions&, const sun::Study&);
  const std::pair<const std::string&, Make> files[] = {
      {options.csv,
       [](const SunOptions& o, const sun::Study& of) { return io::write_file(o.csv, sun::csv_of(of)); }},
      {options.json,
       [](const SunOptions& o, const sun::Study& of) { return io::write_file(o.json, sun::json_of(of)); }},
      {options.raster,
       [](const SunOptions& o, const sun::Study& of) {
         return io::write_file(o.raster, sun::geotiff_of(of, o.epsg));
       }},
      {options.plan, write_plan},
      {options.model, write_model}};
  for (const auto& [file, make] : files)
    if (!file.empty())
      if (auto written = make(options, study); !written) return written;
  return {};
}

void print_summary(const SunOptions& options, const sun::Study& study, double ms) {
  double sum = 0, weight = 0, least = HUGE_VAL, most = 0;
  for (std::size_t i = 0; i < study.hours.sums.size(); ++i) {
    const double area = study.receivers.list[i].area_m2, counts = area > 0 ? area : 1;
    const double value = sun::value_of(study, i);
    sum += counts * value, weight += counts, least = std::min(least, value), most = std::max(most, value);
  }
  const char* what = sun::quantity_of(study.suns).name;
  const char* kinds[] = {"faces", "cells", "points"};
  print_out("{} {}, {} points, {} suns, {} {:.4g} to {:.4g}, mean {:.4g}, {:.2f} s\n",
            study.receivers.list.size(), kinds[static_cast<int>(study.receivers.kind)],
            study.receivers.positions.size(), study.suns.list.size(), what, least, most, sum / weight,
            ms / 1e3);
  if (!options.model.empty() || !options.plan.empty())
    print_out("colours: viridis, 0 to {:.4g} {}\n", chosen_scale(options, study).most, what);
}

Expected<void> check_sun_outputs(const SunScene& scene, const SunOptions& options) {
  std::vector<std::filesystem::path> inputs = scene.staged.inputs;
  for (const std::string& file : {options.suns, options.weather, options.points})
    if (!file.empty()) inputs.emplace_back(file);
  return check_files_apart(
      inputs, [&](const std::function<Expected<void>(const OutputName&)>& use) -> Expected<void> {
        for (const auto& [option, file] :
             {OutputName{"-o", options.model}, OutputName{"--csv", options.csv},
              OutputName{"--json", options.json}, OutputName{"--png", options.plan},
              OutputName{"--tiff", options.raster}}) {
          if (file.empty()) continue;
          if (auto made = settings::make_folder_of(file); !made) return made;
          if (auto used = use({option, file}); !used) return used;
        }
        return {};
      });
}

Expected<int> study_sun(const SunOptions& options) {
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  StopSignals stop(options.timeout_s, StopSignals::Start::at_once);
  const auto scene = stage_for_sun(options);
  if (!scene) return tl::unexpected(scene.error());
  if (auto apart = check_sun_outputs(*scene, options); !apart) return tl::unexpected(apart.error());
  const Scene& staged = scene->staged.scene;
  const auto suns = find_suns(options, staged.frame);
  if (!suns) return tl::unexpected(suns.error());
  const auto receivers = find_receivers(options, *scene);
  if (!receivers) return tl::unexpected(receivers.error());
  if (options.sky_parts > 0 || suns->kind == sun::SunKind::radiation)
    if (auto facing = sun::check_facings(receivers->points()); !facing) return tl::unexpected(facing.error());
  if (!options.quiet) print_warnings(staged.warnings), print_sun_notes(options, *suns);
  stop.be_orderly();
  base::Stopwatch watch;
  const auto counted = count_hours(options, *scene, *receivers, *suns, stop.flag());
  if (is_stop(counted)) {
    print_error("tenebra: stopped before the hours were counted, nothing is written\n");
    return stop.exit_code();
  }
  if (!counted) return tl::unexpected(counted.error());
  const sun::Study study{staged, scene->input.geometry, *receivers,
                         *suns,  counted->hours,        counted->sky ? &*counted->sky : nullptr};
  if (auto written = write_hours(options, study); !written) return tl::unexpected(written.error());
  if (!options.quiet) print_summary(options, study, watch.lap_ms());
  return 0;
}

}  // namespace

void add_sun_command(CLI::App& program, Run& run) {
  CLI::App& command = add_command(program, "sun", "Count the hours of sun on faces, the ground or points");
  const auto options = std::make_shared<SunOptions>();
  set_examples(command, sun_examples);
  add_sun_options(command, *options);
  when_chosen(command, [options, &command, &run] {
    const auto settled = settle_sun_options(command, *options);
    run = [options, settled]() -> Expected<int> {
      if (!settled) return tl::unexpected(settled.error());
      return study_sun(*options);
    };
  });
}

}  // namespace tenebra::viewer
