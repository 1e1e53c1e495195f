// tenebra-bench ao: errors, speed, growth, memory and steadiness of ambient occlusion from displacement
// fields.
#include <fmt/format.h>
#include <array>
#include <cstdio>
#include <memory>

#include "bench/ao/ao_session.h"
#include "bench/ao/scenes/ao_scene_first.h"
#include "bench/ao/scenes/ao_scene_truth.h"
#include "bench/ao/scenes/ao_scene_views.h"
#include "bench/common/bench_parts.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<AoSession>{"errors", measure_errors},   BenchPart<AoSession>{"surface", measure_surface},
    BenchPart<AoSession>{"growth", measure_growth},   BenchPart<AoSession>{"many", measure_many},
    BenchPart<AoSession>{"lookups", measure_lookups}, BenchPart<AoSession>{"frames", measure_frames},
    BenchPart<AoSession>{"flicker", measure_flicker}, BenchPart<AoSession>{"scenes", measure_scenes}};
const std::span<const BenchPart<AoSession>> all_parts(parts);

void print_headlines(const AoHeadline& h) {
  std::printf("\n");
  print_headline("ao.outside_rms_255", h.outside_rms_255, 2);
  print_headline("ao.paper_rms_255", h.paper_rms_255, 2);
  print_headline("ao.inside_rms_255", h.inside_rms_255, 2);
  print_headline("ao.surface_rms_255", h.surface_rms_255, 2);
  print_headline("ao.lookup_speedup", h.lookup_speedup, 1);
  print_headline("ao.frame_speedup", h.frame_speedup, 1);
  print_headline("ao.frame_speedup_half", h.frame_speedup_half, 1);
  print_headline("ao.growth_1k_to_1m", h.growth_1k_to_1m, 1);
  print_headline("ao.bytes", h.bytes, 0);
  print_headline("ao.scene_rms_worst", h.scene_rms_worst, 2);
  print_headline("ao.scene_p99_worst", h.scene_p99_worst, 1);
  print_headline("ao.scene_max_worst", h.scene_max_worst, 1);
  print_headline("ao.exact_rms_worst", h.exact_rms_worst, 2);
  print_headline("ao.exact_max_worst", h.exact_max_worst, 1);
  print_headline("ao.scene_speedup_geomean", h.scene_speedup_geomean, 2);
  print_headline("ao.scene_speedup_worst", h.scene_speedup_worst, 2);
  print_headline("ao.exact_speedup_geomean", h.exact_speedup_geomean, 2);
  print_headline("ao.first_frame_warm", h.first_frame_warm, 2);
  print_headline("ao.flicker_mean_255", h.flicker_mean_255, 3);
  if (h.estimate_worst) print_headline("ao.estimate_worst", h.estimate_worst, 2);
}

Expected<void> write_files(const AoSession& session, const std::vector<std::string>& settings) {
  if (auto written = session.report.write(settings); !written) return written;
  const std::filesystem::path& csv = session.options.csv;
  if (csv.empty()) return {};
  for (const auto& [name, picture] : session.pictures) {
    const auto path = csv.parent_path() / fmt::format("{}_{}.png", csv.stem().string(), name);
    if (auto written = io::write_png(path, picture); !written) return written;
  }
  return {};
}

struct AoArguments {
  AoSceneOptions scenes;
  FirstFrameTask first_frame;
};

Expected<void> measure(const PartsArguments& arguments, const AoArguments& own) {
  if (!own.first_frame.view.empty()) return run_first_frame(own.first_frame, arguments.options);
  AoSession session{.options = arguments.options,
                    .effort = arguments.effort(),
                    .report = Report(arguments.options.csv),
                    .scenes = own.scenes};
  if (auto done = measure_parts(arguments, all_parts, session); !done) return done;
  if (auto written = write_files(session, parts_settings(arguments)); !written) return written;
  if (!session.notes.empty()) std::printf("\n");
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  print_headlines(session.headline);
  return {};
}

void add_scene_options(CLI::App& command, AoSceneOptions& options) {
  const auto names = ao_scene_names();
  command
      .add_option(
          "--views", options.views,
          fmt::format("scenes: those whose name contains one of these, of {} [all]", fmt::join(names, ", ")))
      ->type_name("TEXT,...")
      ->delimiter(',');
  command.add_option("--sizes", options.sizes, "scenes: pixels each way [512,1024; with --quick 512]")
      ->type_name("N,...")
      ->delimiter(',')
      ->check(CLI::Range(16, 4096));
  command
      .add_option("--truth-folder", options.truth_folder,
                  "scenes: where truths are kept for the next run, one file for each view, size and content; "
                  "'' for nowhere\n"
                  "[$XDG_CACHE_HOME/tenebra/bench or ~/.cache/tenebra/bench]")
      ->type_name("FOLDER");
  command
      .add_option("--truth-step", options.truth_step,
                  "scenes: errors are taken at every Nth pixel of every Nth row [1; with --quick 5]")
      ->type_name("N")
      ->check(CLI::Range(1, 64));
  command.add_flag("--only-ours", options.only_ours, "scenes: errors and times without the opponent");
  command
      .add_option("--pictures", options.pictures,
                  "scenes: writes truths, values and errors as PNG, and names the worst pixels")
      ->type_name("FOLDER");
}

}  // namespace

void add_ao_command(CLI::App& program, Run& run) {
  const auto own = std::make_shared<AoArguments>();
  own->scenes.truth_folder = default_truth_folder();
  CLI::App& command = add_parts_command(
      program, run, {"ao", "Ambient occlusion from displacement fields"}, part_names(all_parts),
      [own](const PartsArguments& arguments) { return measure(arguments, *own); });
  add_scene_options(command, own->scenes);
  add_first_frame_options(command, own->first_frame);
}

}  // namespace tenebra::bench
