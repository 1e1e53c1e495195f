// What the commands that consist of parts share: --only, --tiny, the checks before a run, and the run itself.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/simd_level.h>
#include "bench/common/bench_command.h"
#include "bench/common/bench_report.h"

namespace tenebra::bench {

/// How much is measured. Tiny runs check that all parts run; their figures mean nothing.
enum class Effort { tiny, quick, full };

struct PartsArguments {
  BenchOptions options;
  std::vector<std::string> only;  ///< empty: all
  bool tiny = false;

  Effort effort() const { return tiny ? Effort::tiny : options.quick ? Effort::quick : Effort::full; }
  bool wants(const std::string& part) const {
    return only.empty() || std::find(only.begin(), only.end(), part) != only.end();
  }
};

/// One part of a command; it works on what the parts share.
template <class Session>
struct BenchPart {
  const char* name;
  Expected<void> (*measure)(Session&);
};
template <class Session>
std::vector<std::string> part_names(std::span<const BenchPart<Session>> parts) {
  std::vector<std::string> names;
  for (const auto& part : parts) names.emplace_back(part.name);
  return names;
}

struct CommandName {
  const char* name;
  const char* help;
  const char* footer = "";  ///< below the options: what the figures are
};
/// A subcommand with --data, --quick, --threads, --csv, --only and --tiny. Its run refuses what no part could
/// work with, names the machine on standard output, and calls `measure` on as many threads as asked for.
CLI::App& add_parts_command(CLI::App& program, Run& run, CommandName command,
                            const std::vector<std::string>& names,
                            const std::function<Expected<void>(const PartsArguments&)>& measure);

/// The chosen parts in their order, until one fails.
template <class Session>
Expected<void> measure_parts(const PartsArguments& arguments, std::span<const BenchPart<Session>> parts,
                             Session& session) {
  for (const auto& part : parts) {
    if (!arguments.wants(part.name)) continue;
    if (auto done = part.measure(session); !done) return done;
  }
  return {};
}

/// The head of a CSV: "threads: 2", "simd: avx512", "quick: true".
std::vector<std::string> parts_settings(const PartsArguments& arguments,
                                        SimdLevel simd = SimdLevel::automatic);

/// Prints a headline().
void print_headline(const std::string& name, const std::optional<double>& value, int digits);

}  // namespace tenebra::bench
