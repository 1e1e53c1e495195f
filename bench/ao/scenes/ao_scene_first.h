// The first frame of a process whose fields and samples lie on disk: a process of its own, started for it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include <tenebra/expected.h>
#include "bench/common/bench_command.h"

namespace tenebra::bench {

/// The task of the other process.
struct FirstFrameTask {
  std::string view;  ///< one of ao_scene_names(); empty: nothing
  int size = 512;
  int walkers = 50;
  bool tiny = false;
  std::filesystem::path fields;  ///< filled before, by the same setting
};

/// Options that only such a process is given; not in --help.
void add_first_frame_options(CLI::App& command, FirstFrameTask& task);

/// In that process: the view's first frame at the default setting and some later ones, and a line with what
/// the first took over the median of the later.
Expected<void> run_first_frame(const FirstFrameTask& task, const BenchOptions& options);

/// Starts this program once more for the task, and reads the line.
Expected<double> first_over_later(const FirstFrameTask& task, const BenchOptions& options);

}  // namespace tenebra::bench
