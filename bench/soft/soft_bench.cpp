// tenebra-bench soft: the exact soft shadows beside Embree's shadow rays.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/fail.h"
#include "bench/common/bench_command.h"
#include "bench/soft/soft_pictures.h"
#include "bench/soft/soft_tables.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

struct SoftOptions : BenchOptions {
  std::filesystem::path pictures;
  std::vector<int> size{1280, 720};
  std::vector<std::string> only;
  std::vector<double> light_sizes;
  bool only_errors = false, only_large = false;
};

/// How much is run.
struct Effort {
  int rounds;
  bool whole_curve;
  bool more_frames;
  int race_rounds;
  std::size_t race_rays;  ///< of the rival, at most
};

Effort effort(bool quick) {
  if (quick) return {7, false, false, 3, 256};
  return {7, true, true, 5, 1024};
}

Expected<void> check(const SoftOptions& options) {
  std::error_code ignored;
  if (options.threads < 0)
    return base::fail("--threads: found {}, expected 0 (all cores) or more", options.threads);
  if (!options.data.empty() && !std::filesystem::is_directory(options.data, ignored))
    return base::fail("--data: {} is not a folder, expected the folder of robots, museum and kitchen",
                      options.data.string());
  const auto names = scene_names();
  for (const std::string& name : options.only) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      return base::fail("--only: found {}, expected {}", name, fmt::join(names, ", "));
  }
  if (options.size[0] < 16 || options.size[1] < 16 || options.size[0] > 8192 || options.size[1] > 8192)
    return base::fail("--size: found {} {}, expected 16 to 8192 pixels each", options.size[0],
                      options.size[1]);
  for (const double percent : options.light_sizes) {
    if (!(percent > 0 && percent <= 100))
      return base::fail("--light-sizes: found {}, expected more than 0 and at most 100 percent", percent);
  }
  if (!options.pictures.empty() && !std::filesystem::is_directory(options.pictures, ignored))
    return base::fail("--pictures: {} is not a folder, expected one to write to", options.pictures.string());
  return Report(options.csv).check();
}

/// The race under squares of other sizes.
Expected<void> race_sizes(const SoftView& view, const SoftOptions& options, SoftResults& results,
                          Report& report) {
  const Effort how = effort(options.quick);
  for (const double percent : options.light_sizes) {
    SoftView sized = view;
    sized.name += fmt::format(", {:g} %", percent);
    auto light = square_light(view.frame, percent);
    if (!light) return base::fail("{}: {}", sized.name, light.error().message);
    sized.light = std::move(*light);
    results.sized_races.push_back(race_errors(sized, how.race_rounds, how.race_rays, report));
    results.sized_races.back().percent = percent;
  }
  return {};
}

Expected<void> measure_large_lights(const SoftView& view, const SoftOptions& options, SoftResults& results,
                                    Report& report) {
  if (view.large) results.large.push_back(measure_large(view, report));
  if (!view.counted || !view.name.starts_with("kitchen")) return {};
  auto grown = measure_grown(view, options.quick ? 1 : 3, report);
  if (!grown) return tl::unexpected(grown.error());
  results.grown.push_back(std::move(*grown));
  return {};
}

Expected<void> measure_view(const SoftView& view, const SoftOptions& options, SoftResults& results,
                            Report& report) {
  const Effort how = effort(options.quick);
  if (options.only_large || (view.large && !options.only_errors))
    return measure_large_lights(view, options, results, report);
  if (view.large) return {};
  if (view.counted || view.name.starts_with("court"))
    results.races.push_back(race_errors(view, how.race_rounds, how.race_rays, report));
  if (!view.sun_only) {
    if (auto raced = race_sizes(view, options, results, report); !raced) return raced;
  }
  if (view.sun) {
    SoftView sunny = view;
    sunny.name += ", sun";
    sunny.light = *view.sun;
    results.sun_races.push_back(race_errors(sunny, how.race_rounds, how.race_rays, report));
  }
  if (options.only_errors || view.sun_only) return {};
  ContestPlan plan;
  plan.rounds = how.rounds;
  plan.whole_curve = how.whole_curve;
  plan.pictures = !options.pictures.empty();
  Contest contest = run_contest(view, plan, report);
  if (plan.pictures) {
    const auto written = write_pictures(contest, options.size[0], options.size[1], options.pictures);
    if (!written) return written;
  }
  progress(view.name + ": solver bsp");
  SoftShadowConfig bsp;
  bsp.solver = SoftSolver::bsp;
  const TreeCost trees = tree_cost(view, view.frame.points, bsp);
  report.add({"trees", view.name, "bsp", "", "time", trees.ms, "ms"});
  report.add({"trees", view.name, "bsp", "", "peak tree memory", trees.bytes, "bytes"});
  results.trees.push_back({view.name, contest.tenebra_ms, trees});
  results.contests.push_back(std::move(contest));
  return measure_large_lights(view, options, results, report);
}

Expected<void> run_soft(const SoftOptions& options) {
  if (auto checked = check(options); !checked) return checked;
  Report report(options.csv);
  SoftResults results;
  const ViewChoice choice{.width = options.size[0],
                          .height = options.size[1],
                          .more_frames = effort(options.quick).more_frames,
                          .large_lights = true,
                          .only = options.only};
  Expected<void> done;
  int threads = 0;
  with_threads(options.threads, [&] {
    threads = thread_count();
    done = for_each_view(options, choice, results.skipped,
                         [&](const SoftView& view) { return measure_view(view, options, results, report); });
  });
  if (!done) return done;
  add_soft_plots(results, report);
  const std::vector<std::string> settings{fmt::format("threads: {}", threads),
                                          fmt::format("size: {}x{}", options.size[0], options.size[1]),
                                          fmt::format("quick: {}", options.quick)};
  if (auto written = report.write(settings); !written) return written;
  std::printf("%s\n%s", soft_tables(results).c_str(), soft_summary(results).c_str());
  return {};
}

}  // namespace

void add_soft_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("soft", "Exact soft shadows compared with Embree's shadow rays");
  const auto options = std::make_shared<SoftOptions>();
  add_bench_options(*command, *options);
  command->add_option("--pictures", options->pictures, "Write Tenebra's and Embree's pictures at equal time")
      ->type_name("FOLDER");
  command->add_option("--size", options->size, "Width and height")->expected(2)->group("");  // for tests
  command
      ->add_option("--only", options->only,
                   "Scenes by name: robots, museum5, kitchen, museum5x64,\ncourt, city,\ngallery")
      ->type_name("NAME");
  command->add_flag("--only-errors", options->only_errors,
                    "Only the comparison at allowed errors (--soft-error)");
  command
      ->add_flag("--only-large", options->only_large, "Only lights of half the diagonal, and soft.large_gain")
      ->excludes("--only-errors");
  command
      ->add_option("--light-sizes", options->light_sizes,
                   "Also compare under squares of these sides, in percent of the\n"
                   "scene's diagonal: 1 10 25")
      ->type_name("PERCENT");
  command->callback([options, &run] { run = [options] { return run_soft(*options); }; });
}

}  // namespace tenebra::bench
