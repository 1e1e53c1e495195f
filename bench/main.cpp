// tenebra-bench: what each method costs and how exact it is, beside its peers. One subcommand per method.
#include <cstdio>
#include <string>

#include "bench/common/bench_command.h"

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
  tenebra::bench::add_bake_command(program, run);
  tenebra::bench::add_sun_command(program, run);
  tenebra::bench::add_trade_command(program, run);
  tenebra::bench::add_paper_command(program, run);
  tenebra::bench::add_promise_command(program, run);
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
