#include "bench_command.h"

namespace tenebra::bench {

void add_soft_command(CLI::App&, Run&) {}

}  // namespace tenebra::bench
