// tenebra-bench hard: the default hard shadows beside Embree's rays; growth, steadiness, and the experiments
// of Olsson and Assarsson 2011.
#include <array>
#include <cstdio>

#include "bench_parts.h"
#include "hard_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{BenchPart<HardSession>{"frames", measure_hard_frames},
                           BenchPart<HardSession>{"growth", measure_hard_growth},
                           BenchPart<HardSession>{"variance", measure_hard_variance},
                           BenchPart<HardSession>{"paper", measure_hard_paper}};
const std::span<const BenchPart<HardSession>> all_parts(parts);

void print_headlines(const HardHeadline& h) {
  std::printf("\n");
  print_headline("hard.dynamic_geomean", h.dynamic_geomean, 3);
  print_headline("hard.static_geomean", h.static_geomean, 3);
  print_headline("hard.dynamic_worst", h.dynamic_worst, 3);
  print_headline("hard.static_worst", h.static_worst, 3);
  print_headline("hard.growth_static_1.8m", h.growth_static_1_8m, 3);
  print_headline("hard.p99_over_median", h.p99_over_median, 3);
}

Expected<void> measure(const PartsArguments& arguments) {
  HardSession session{
      .options = arguments.options, .effort = arguments.effort(), .report = Report(arguments.options.csv)};
  if (auto done = measure_parts(arguments, all_parts, session); !done) return done;
  if (auto written = session.report.write(parts_settings(arguments)); !written) return written;
  std::printf("\n");
  for (const std::string& name : session.skipped) std::printf("%s: skipped, not there\n", name.c_str());
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  print_headlines(session.headline);
  return {};
}

}  // namespace

void print_hard_table(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  std::printf("\n%s\n%s", title.c_str(), text_table(rows).c_str());
  std::fflush(stdout);
}

void add_hard_command(CLI::App& program, Run& run) {
  add_parts_command(
      program, run,
      {"hard", "Hard shadows beside Embree's rays; the experiments of Olsson and Assarsson 2011"},
      part_names(all_parts), measure);
}

}  // namespace tenebra::bench
