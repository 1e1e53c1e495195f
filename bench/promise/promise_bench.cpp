// tenebra-bench promise: whether --soft-error keeps what it says, on scenes that nobody tuned for: every
// light alone, of several sizes, in frames and random views, against the exact picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "bench/common/bench_command.h"
#include "bench/common/bench_report.h"
#include "bench/promise/promise_runs.h"
#include "session/session.h"

namespace tenebra::bench {
namespace {

struct PromiseOptions : BenchOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<double> light_sizes{0.5, 4, 25};
  int step = 10, views = 4, width = 320, height = 180, rounds = 0;
  unsigned seed = 1;
};

constexpr std::array sun_degrees{0.53, 5.0};

/// Random views of a scene without cameras of its own: from a sphere around its middle, above its ground.
std::vector<session::Viewpoint> random_views(const session::StagedScene& staged, const FrameGeometry& frame,
                                             int count, std::mt19937& random) {
  glm::vec3 low(HUGE_VALF), high(-HUGE_VALF);
  for (const glm::uvec3& t : frame.triangles)
    for (int k = 0; k < 3; ++k)
      low = glm::min(low, frame.positions[t[k]]), high = glm::max(high, frame.positions[t[k]]);
  const glm::vec3 centre = 0.5f * (low + high);
  const float radius = 0.5f * glm::length(high - low);
  std::uniform_real_distribution<float> turn(0, 6.2831853f), rise(0.1f, 0.9f), away(1.2f, 2.2f);
  std::vector<session::Viewpoint> views;
  for (int i = 0; i < count; ++i) {
    const float azimuth = turn(random), up = rise(random), flat = std::sqrt(1 - up * up);
    const glm::vec3 way(flat * std::cos(azimuth), up, flat * std::sin(azimuth));
    views.push_back(
        {staged.clip, 0, session::PlacedCamera{centre + away(random) * radius * way, centre, {0, 1, 0}, 45}});
  }
  return views;
}

/// The scene's own camera where the file has one, else random ones.
Expected<void> measure_scene(const PromiseOptions& options, const std::filesystem::path& file,
                             PromiseTable& table) {
  settings::SceneSettings scene;
  scene.file = file.string();
  scene.exposure_given = true;
  scene.size = settings::Size{options.width, options.height};
  render::RasterChoice raster;
  raster.kind = render::RasterKind::cpu;
  auto opened = session::Session::open(scene, raster);
  if (!opened) return base::fail("{}: {}", file.string(), opened.error().message);
  const session::StagedScene& staged = opened->staged();
  std::mt19937 random(options.seed);
  const bool own_camera = !staged.added.camera;
  for (int frame = 0; frame < staged.frames(); frame += options.step) {
    const double time_s = staged.time_of_frame(frame);
    std::vector<session::Viewpoint> views{session::viewpoint_of(staged, scene)};
    opened->place(time_s, session::rays_of(staged, views[0], time_s, *scene.size));
    if (!own_camera) views = random_views(staged, opened->placed().geometry, options.views, random);
    for (std::size_t v = 0; v < views.size(); ++v) {
      opened->place(time_s, session::rays_of(staged, views[v], time_s, *scene.size));
      const std::string name = own_camera ? fmt::format("{} {}", file.stem().string(), frame)
                                          : fmt::format("{} {} view {}", file.stem().string(), frame, v);
      for (std::size_t light = 0; light < opened->placed().lights.size(); ++light) {
        const auto number = static_cast<std::size_t>(opened->placed().lights[light].light);
        const bool sun = staged.scene.lights[number].type == LightType::directional;
        for (const double size : sun ? std::span<const double>(sun_degrees) : options.light_sizes) {
          progress(fmt::format("{} light {} of {}", name, light, size));
          const PromiseView view{name, static_cast<int>(light), sun, size, options.rounds};
          if (auto done = measure_view(*opened, view, table); !done) return done;
        }
      }
    }
  }
  return {};
}

Expected<void> measure(const PromiseOptions& options) {
  if (options.scenes.empty()) return base::fail("found no scene, expected files");
  Report report(options.csv);
  if (auto checked = report.check(); !checked) return checked;
  PromiseTable table;
  Expected<void> done;
  with_threads(options.threads, [&] {
    for (const std::filesystem::path& file : options.scenes)
      if (done = measure_scene(options, file, table); !done) return;
  });
  table.print(options.rounds > 0);
  table.add_to(report);
  const std::array settings{fmt::format("seed: {}", options.seed)};
  const auto written = report.write(settings);
  return done ? written : done;
}

}  // namespace

void add_promise_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "promise", "Whether soft shadows err by no more than --soft-error allows, on any scene");
  const auto options = std::make_shared<PromiseOptions>();
  command->add_option("SCENE", options->scenes, "Scene files")->required();
  command->add_option("--light-sizes", options->light_sizes, "Percent of the diagonal [0.5 4 25]")
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--step", options->step, "Every N-th frame [10]")->check(CLI::Range(1, 1000000));
  command->add_option("--views", options->views, "Random views where a file has no camera [4]");
  command->add_option("--seed", options->seed, "Of the random views [1]");
  command->add_option("--size", options->width, "Width of the pictures; 16:9 [320]")
      ->check(CLI::Range(16, 8192));
  command->add_option("--rounds", options->rounds,
                      "Times each error against exact so often, alternately [0: no times]");
  command->add_option("--threads", options->threads, "Threads [0: all]")->check(CLI::Range(0, 1024));
  command->add_option("--csv", options->csv, "File for all figures");
  command->footer(
      "promise_within: part of the runs whose RMS over the penumbra is at most E, for E of 8, 4, 2, 1 and\n"
      "0.5/255 of white (99.9th percentile of what the light shows); promise_worst: largest RMS / E;\n"
      "estimate_within: part whose estimate is within 1.5 of the truth, both at least 0.25. Runs where\n"
      "nothing was sampled are exact and do not count. slower_worst: largest time over that of exact or of\n"
      "a smaller error.");
  command->callback([options, &run] {
    options->height = options->width * 9 / 16;
    run = [options] { return measure(*options); };
  });
}

}  // namespace tenebra::bench
