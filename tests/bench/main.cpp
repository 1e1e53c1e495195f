// tenebra-bench: what each method costs and how exact it is, beside its peers. One subcommand a method.
#include <cstdio>
#include <string>

#include "bench/common/bench_command.h"

namespace tenebra::bench {

void add_bench_options(CLI::App& command, BenchOptions& options) {
  command.add_option("--data", options.data, "Folder of the scenes that do not come with the program")
      ->type_name("FOLDER");
  command.add_flag("--quick", options.quick, "Fewer frames and runs: within 8 minutes on two cores");
  command.add_option("--threads", options.threads, "Threads of all contestants [0: all cores]")
      ->type_name("N");
  command.add_option("--csv", options.csv, "All figures; plots are written beside it")->type_name("FILE.csv");
}

}  // namespace tenebra::bench

namespace {

int refuse(const std::string& sentence) {
  std::fprintf(stderr, "tenebra-bench: %s\n", sentence.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Measures Tenebra and its peers side by side.");
  program.require_subcommand(1);
  tenebra::bench::Run run;
  tenebra::bench::add_hard_command(program, run);
  tenebra::bench::add_soft_command(program, run);
  tenebra::bench::add_ao_command(program, run);
  tenebra::bench::add_trade_command(program, run);
  tenebra::bench::add_frame_command(program, run);
  tenebra::bench::add_picture_command(program, run);
  tenebra::bench::add_hash_command(program, run);
  tenebra::bench::add_viewer_command(program, run);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help
    return refuse(error.what());
  }
  const auto done = run();
  return done ? 0 : refuse(done.error().message);
}
