#include "bench/common/bench_session.h"

#include <cstdio>

namespace tenebra::bench {

void print_end(const std::string& command, std::span<const std::string> skipped,
               const std::vector<LastLine>& lines) {
  std::printf("\n");
  for (const std::string& sentence : skipped) std::printf("%s\n", sentence.c_str());
  for (const LastLine& line : lines) print_headline(command + "." + line.name, line.value, line.digits);
}

}  // namespace tenebra::bench
