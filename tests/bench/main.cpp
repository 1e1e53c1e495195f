// tenebra-bench: what each method costs and how exact it is, beside its peers. One subcommand a method.
#include <cstdio>

#include "bench_command.h"

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

int main(int argc, char** argv) {
  CLI::App program("Measures Tenebra and its peers side by side.");
  program.require_subcommand(1);
  tenebra::bench::Run run;
  tenebra::bench::add_hard_command(program, run);
  tenebra::bench::add_soft_command(program, run);
  tenebra::bench::add_ao_command(program, run);
  tenebra::bench::add_trade_command(program, run);
  CLI11_PARSE(program, argc, argv);
  if (const auto done = run(); !done) {
    std::fprintf(stderr, "tenebra-bench: %s\n", done.error().message.c_str());
    return 1;
  }
  return 0;
}
