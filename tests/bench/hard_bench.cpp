// tenebra-bench hard: the default hard shadows beside Embree's rays; growth, steadiness, and the experiments
// of Olsson and Assarsson 2011.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "base/machine.h"
#include "hard_session.h"
#include "parallel/parallel.h"
#include "simd/simd_level.h"

namespace tenebra::bench {
namespace {

struct Part {
  const char* name;
  Expected<void> (*measure)(HardSession&);
};
constexpr std::array parts{Part{"frames", measure_hard_frames}, Part{"growth", measure_hard_growth},
                           Part{"variance", measure_hard_variance}, Part{"paper", measure_hard_paper}};

struct HardArguments {
  BenchOptions options;
  std::vector<std::string> only;
  bool tiny = false;
  std::string simd = "auto";
};

std::string part_names() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Options that no part could work with.
Expected<void> check_options(const HardArguments& arguments) {
  const BenchOptions& o = arguments.options;
  if (o.threads < 0) return fail("--threads: found {}, expected 0 (all cores) or more", o.threads);
  std::error_code ignored;
  if (!o.data.empty() && !std::filesystem::is_directory(o.data, ignored))
    return fail("--data: {} is not a folder, expected the folder of robots, museum and kitchen",
                o.data.string());
  const auto simd = simd_level_from_name(arguments.simd);
  if (!simd || (*simd != SimdLevel::automatic && !simd_level_supported(*simd)))
    return fail("--simd: found {}, expected auto or a level of this machine: scalar, sse4, avx2, avx512",
                arguments.simd);
  for (const std::string& name : arguments.only) {
    if (std::none_of(parts.begin(), parts.end(), [&](const Part& p) { return p.name == name; }))
      return fail("--only: found {}, expected {}", name, part_names());
  }
  return Report(o.csv).check();
}

std::string session_simd(const HardSession& session) {
  return std::string(
      simd_level_name(session.simd == SimdLevel::automatic ? best_simd_level() : session.simd));
}

/// What was left out is not a number.
void print_headline(const HardHeadline& h) {
  const auto line = [](const char* name, const std::optional<double>& value) {
    std::printf("hard.%s: %s\n", name, value ? fmt::format("{:.3f}", *value).c_str() : "nan");
  };
  std::printf("\n");
  line("dynamic_geomean", h.dynamic_geomean);
  line("static_geomean", h.static_geomean);
  line("dynamic_worst", h.dynamic_worst);
  line("static_worst", h.static_worst);
  line("growth_static_1.8m", h.growth_static_1_8m);
  line("p99_over_median", h.p99_over_median);
}

Expected<void> measure_parts(HardSession& session, const std::vector<std::string>& only) {
  for (const Part& part : parts) {
    if (!only.empty() && std::find(only.begin(), only.end(), part.name) == only.end()) continue;
    if (auto done = part.measure(session); !done) return done;
  }
  const std::array settings{fmt::format("threads: {}", thread_count()),
                            fmt::format("simd: {}", session_simd(session)),
                            fmt::format("quick: {}", session.options.quick)};
  if (auto written = session.report.write(settings); !written) return written;
  std::printf("\n");
  for (const std::string& name : session.skipped) std::printf("%s: skipped, not there\n", name.c_str());
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  print_headline(session.headline);
  return {};
}

Expected<void> run_hard(const HardArguments& arguments) {
  if (auto fine = check_options(arguments); !fine) return fine;
  HardSession session{.options = arguments.options, .report = Report(arguments.options.csv)};
  session.simd = *simd_level_from_name(arguments.simd);
  if (arguments.options.quick) session.effort = HardEffort::quick;
  if (arguments.tiny) session.effort = HardEffort::tiny;
  if (auto fine = session.report.check(); !fine) return fine;
  Expected<void> done;
  with_threads(arguments.options.threads, [&] {
    std::printf("%s; threads: %d, simd: %s\n", machine_description().c_str(), thread_count(),
                session_simd(session).c_str());
    done = measure_parts(session, arguments.only);
  });
  return done;
}

}  // namespace

void print_hard_table(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  std::printf("\n%s\n%s", title.c_str(), text_table(rows).c_str());
  std::fflush(stdout);
}

void add_hard_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "hard", "Hard shadows beside Embree's rays; the experiments of Olsson and Assarsson 2011");
  const auto arguments = std::make_shared<HardArguments>();
  add_bench_options(*command, arguments->options);
  command->add_option("--only", arguments->only, fmt::format("Some parts: {} [all]", part_names()))
      ->type_name("PART,...")
      ->delimiter(',');
  command->add_option("--simd", arguments->simd, "Instructions that all are kept to [auto]")
      ->type_name("LEVEL");
  command->add_flag("--tiny", arguments->tiny, "Check that all parts run; the figures mean nothing");
  command->callback([arguments, &run] { run = [arguments] { return run_hard(*arguments); }; });
}

}  // namespace tenebra::bench
