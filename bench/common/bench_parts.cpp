#include <fmt/format.h>

#include "bench/common/bench_parts.h"

#include <cstdio>
#include <limits>
#include <memory>

#include "base/fail.h"
#include "base/machine.h"
#include "bench/common/bench_data.h"
#include "bench/common/bench_frame.h"
#include "parallel/parallel.h"

namespace tenebra::bench {

void add_bench_options(CLI::App& command, BenchOptions& options) {
  command.add_option("--data", options.data, "Folder of scenes that do not come with the program")
      ->type_name("FOLDER");
  command.add_flag("--quick", options.quick,
                   "Fewer frames and runs: within a quarter of an hour on two cores");
  command.add_option("--threads", options.threads, "Threads of all contestants [0: all cores]")
      ->type_name("N");
  command.add_option("--csv", options.csv, "File for all figures; plots are written beside it")
      ->type_name("FILE.csv");
}

namespace {

Expected<void> check(const PartsArguments& arguments, const std::vector<std::string>& names) {
  const BenchOptions& o = arguments.options;
  if (o.threads < 0) return base::fail("--threads: found {}, expected 0 (all cores) or more", o.threads);
  std::error_code ignored;
  if (!o.data.empty() && !std::filesystem::is_directory(o.data, ignored))
    return base::fail("--data: {} is not a folder, expected the folder of robots, museum and kitchen",
                      o.data.string());
  for (const std::string& name : arguments.only) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      return base::fail("--only: found {}, expected {}", name, fmt::join(names, ", "));
  }
  return Report(o.csv).check();
}

Expected<void> run_parts(const PartsArguments& arguments, const std::vector<std::string>& names,
                         const std::function<Expected<void>(const PartsArguments&)>& measure) {
  if (auto fine = check(arguments, names); !fine) return fine;
  Expected<void> done;
  with_threads(arguments.options.threads, [&] {
    std::printf("%s; threads: %d, simd: %s\n", base::machine_description().c_str(), thread_count(),
                std::string(simd_level_name(best_simd_level())).c_str());
    for (const std::string& sentence : data_sentences(bart_folder(arguments.options.data)))
      std::printf("%s\n", sentence.c_str());
    done = measure(arguments);
  });
  return done;
}

}  // namespace

CLI::App& add_parts_command(CLI::App& program, Run& run, CommandName name,
                            const std::vector<std::string>& names,
                            const std::function<Expected<void>(const PartsArguments&)>& measure) {
  CLI::App* command = program.add_subcommand(name.name, name.help);
  command->footer(name.footer);
  const auto arguments = std::make_shared<PartsArguments>();
  add_bench_options(*command, arguments->options);
  command->add_option("--only", arguments->only, fmt::format("Some parts: {} [all]", fmt::join(names, ", ")))
      ->type_name("PART,...")
      ->delimiter(',');
  command->add_flag("--tiny", arguments->tiny, "Check that all parts run; the figures mean nothing");
  command->callback(
      [arguments, names, measure, &run] { run = [=] { return run_parts(*arguments, names, measure); }; });
  return *command;
}

std::vector<std::string> parts_settings(const PartsArguments& arguments, SimdLevel simd) {
  const SimdLevel level = simd == SimdLevel::automatic ? best_simd_level() : simd;
  return {fmt::format("threads: {}", thread_count()), fmt::format("simd: {}", simd_level_name(level)),
          fmt::format("quick: {}", arguments.options.quick)};
}

void print_headline(const std::string& name, const std::optional<double>& value, int digits) {
  std::fputs(headline(name, value.value_or(std::numeric_limits<double>::quiet_NaN()), digits).c_str(),
             stdout);
}

}  // namespace tenebra::bench
