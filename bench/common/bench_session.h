// One run of a command that consists of parts: what the parts share, and how the run ends.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/common/bench_parts.h"

namespace tenebra::bench {

/// What every command's session has.
struct BenchSession {
  explicit BenchSession(const PartsArguments& arguments)
      : options(arguments.options), effort(arguments.effort()), report(arguments.options.csv) {}

  BenchOptions options;
  Effort effort;
  Report report;
  std::vector<std::string> skipped;  ///< what could not be measured, each a sentence with its reason

  /// The value for this run's effort.
  template <class T>
  T by_effort(T tiny, T quick, T full) const {
    return effort == Effort::tiny ? tiny : effort == Effort::quick ? quick : full;
  }
};

/// The chosen parts in their order, until one fails; then the CSV, which names `simd`.
template <class Session>
Expected<void> measure_and_write(const PartsArguments& arguments, std::span<const BenchPart<Session>> parts,
                                 Session& session, SimdLevel simd = SimdLevel::automatic) {
  if (auto done = measure_parts(arguments, parts, session); !done) return done;
  return session.report.write(parts_settings(arguments, simd));
}

/// One of the last lines, that a script reads.
struct LastLine {
  const char* name;             ///< without the command's
  std::optional<double> value;  ///< empty: not measured
  int digits;
};
/// What was skipped, then the last lines of `command`: "hard.static_worst: 0.40".
void print_end(const std::string& command, std::span<const std::string> skipped,
               const std::vector<LastLine>& lines);

/// A subcommand whose session follows from the common options alone.
template <class Session>
void add_session_command(CLI::App& program, Run& run, CommandName name,
                         std::span<const BenchPart<Session>> parts,
                         std::vector<LastLine> (*last_lines)(const Session&)) {
  const auto measure = [=](const PartsArguments& arguments) -> Expected<void> {
    Session session(arguments);
    if (auto done = measure_and_write(arguments, parts, session); !done) return done;
    print_end(name.name, session.skipped, last_lines(session));
    return {};
  };
  add_parts_command(program, run, name, part_names(parts), measure);
}

}  // namespace tenebra::bench
