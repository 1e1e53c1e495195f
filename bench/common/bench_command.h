// What the subcommands of tenebra-bench share: their options and how they are run.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>

#include <tenebra/expected.h>

namespace tenebra::bench {

struct BenchOptions {
  std::filesystem::path
      data;            ///< folder of scenes that are not ours; empty: where it lies beside the checkout
  bool quick = false;  ///< the same contestants on fewer frames and runs: within 15 minutes on two cores
  int threads = 0;     ///< of all contestants; 0: all cores
  std::filesystem::path csv;  ///< all figures, one row for each measurement; plots lie beside it; empty: none
};

/// What the command line chose to run.
using Run = std::function<Expected<void>()>;

/// Adds --data, --quick, --threads and --csv.
void add_bench_options(CLI::App& command, BenchOptions& options);

void add_hard_command(CLI::App& program, Run& run);
void add_soft_command(CLI::App& program, Run& run);
void add_ao_command(CLI::App& program, Run& run);
void add_bake_command(CLI::App& program, Run& run);
void add_sun_command(CLI::App& program, Run& run);
void add_trade_command(CLI::App& program, Run& run);
void add_paper_command(CLI::App& program, Run& run);
void add_promise_command(CLI::App& program, Run& run);
void add_frame_command(CLI::App& program, Run& run);
void add_picture_command(CLI::App& program, Run& run);
void add_hash_command(CLI::App& program, Run& run);
void add_viewer_command(CLI::App& program, Run& run);

}  // namespace tenebra::bench
