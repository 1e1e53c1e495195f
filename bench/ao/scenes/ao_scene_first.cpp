#include "bench/ao/scenes/ao_scene_first.h"

#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>

#include "base/fail.h"
#include "bench/ao/scenes/ao_scene_ours.h"
#include "support/child_process.h"

namespace tenebra::bench {
namespace {

constexpr const char* label = "first frame over later ones: ";
constexpr int later_frames = 3;
constexpr double patience_s = 300;

}  // namespace

void add_first_frame_options(CLI::App& command, FirstFrameTask& task) {
  const auto hide = [](CLI::Option* option) { option->group(""); };
  hide(command.add_option("--first-frame", task.view));
  hide(command.add_option("--first-frame-size", task.size));
  hide(command.add_option("--first-frame-walkers", task.walkers));
  hide(command.add_option("--first-frame-fields", task.fields));
  hide(command.add_flag("--first-frame-tiny", task.tiny));
}

Expected<void> run_first_frame(const FirstFrameTask& task, const BenchOptions& options) {
  std::vector<std::string> notes;
  const auto view = load_ao_scene(task.view, task.size, task.walkers, options.data, notes);
  if (!view) return tl::unexpected(view.error());
  if (*view == nullptr) return base::fail("{}", notes.back());
  OurAoScene ours(**view, scene_settings((*view)->reach_m, task.fields, task.tiny).front());
  if (auto done = ours.start(); !done) return done;
  for (int i = 0; i < later_frames; ++i) {
    if (auto done = ours.run(); !done) return done;
  }
  std::printf("%s%.4f\n", label, ours.first_ms() / ours.ms());
  return {};
}

Expected<double> first_over_later(const FirstFrameTask& task, const BenchOptions& options) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> arguments{program, "ao", "--threads", fmt::format("{}", options.threads)};
  if (!options.data.empty()) arguments.insert(arguments.end(), {"--data", options.data.string()});
  arguments.insert(arguments.end(),
                   {"--first-frame", task.view, "--first-frame-size", fmt::format("{}", task.size),
                    "--first-frame-walkers", fmt::format("{}", task.walkers), "--first-frame-fields",
                    task.fields.string()});
  if (task.tiny) arguments.emplace_back("--first-frame-tiny");
  testing::ChildProgram child(arguments);
  const auto result = child.wait(patience_s);
  const auto at = result.output.find(label);
  if (result.exit_code != 0 || at == std::string::npos)
    return base::fail("{}: the process for its first frame ended with {}, expected 0: {}", task.view,
                      result.exit_code, result.errors);
  return std::strtod(result.output.c_str() + at + std::string_view(label).size(), nullptr);
}

}  // namespace tenebra::bench
