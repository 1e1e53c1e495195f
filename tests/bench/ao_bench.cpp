// tenebra-bench ao: errors, speed, growth, memory and steadiness of ambient occlusion from displacement
// fields.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "ao_session.h"
#include "base/machine.h"
#include "parallel/parallel.h"
#include "simd/simd_level.h"

namespace tenebra::bench {
namespace {

struct Part {
  const char* name;
  Expected<void> (*measure)(AoSession&);
};
constexpr std::array parts{Part{"errors", measure_errors},   Part{"surface", measure_surface},
                           Part{"growth", measure_growth},   Part{"many", measure_many},
                           Part{"lookups", measure_lookups}, Part{"frames", measure_frames},
                           Part{"flicker", measure_flicker}};

struct AoArguments {
  BenchOptions options;
  std::vector<std::string> only;
  bool tiny = false;
};

/// Options that no part could work with.
Expected<void> check_options(const AoArguments& arguments) {
  const BenchOptions& o = arguments.options;
  if (o.threads < 0) return fail("--threads: found {}, expected 0 (all cores) or more", o.threads);
  std::error_code ignored;
  if (!o.data.empty() && !std::filesystem::is_directory(o.data, ignored))
    return fail("--data: {} is not a folder", o.data.string());
  for (const std::string& name : arguments.only) {
    if (std::none_of(parts.begin(), parts.end(), [&](const Part& p) { return p.name == name; })) {
      return fail("--only: found {}, expected errors, surface, growth, many, lookups, frames or flicker",
                  name);
    }
  }
  return {};
}

/// What was left out is not a number.
void print_headline(const AoHeadline& h) {
  const auto line = [](const char* name, const std::optional<double>& value, int digits) {
    std::printf("ao.%s: %s\n", name, value ? fmt::format("{:.{}f}", *value, digits).c_str() : "nan");
  };
  std::printf("\n");
  line("outside_rms_255", h.outside_rms_255, 2);
  line("paper_rms_255", h.paper_rms_255, 2);
  line("inside_rms_255", h.inside_rms_255, 2);
  line("surface_rms_255", h.surface_rms_255, 2);
  line("lookup_speedup", h.lookup_speedup, 1);
  line("frame_speedup", h.frame_speedup, 1);
  line("frame_speedup_half", h.frame_speedup_half, 1);
  line("growth_1k_to_1m", h.growth_1k_to_1m, 1);
  line("bytes", h.bytes, 0);
}

Expected<void> write_files(const AoSession& session) {
  const std::array settings{fmt::format("threads: {}", thread_count()),
                            fmt::format("simd: {}", simd_level_name(best_simd_level()))};
  if (auto written = session.report.write(settings); !written) return written;
  const std::filesystem::path& csv = session.options.csv;
  if (csv.empty()) return {};
  for (const auto& [name, picture] : session.pictures) {
    const auto path = csv.parent_path() / fmt::format("{}_{}.png", csv.stem().string(), name);
    if (auto written = write_png(path, picture); !written) return written;
  }
  return {};
}

Expected<void> measure_parts(AoSession& session, const std::vector<std::string>& only) {
  for (const Part& part : parts) {
    if (!only.empty() && std::find(only.begin(), only.end(), part.name) == only.end()) continue;
    if (auto done = part.measure(session); !done) return done;
  }
  if (auto written = write_files(session); !written) return written;
  if (!session.notes.empty()) std::printf("\n");
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  print_headline(session.headline);
  return {};
}

Expected<void> run_ao(const AoArguments& arguments) {
  if (auto fine = check_options(arguments); !fine) return fine;
  AoSession session{.options = arguments.options, .report = Report(arguments.options.csv)};
  if (arguments.options.quick) session.effort = Effort::quick;
  if (arguments.tiny) session.effort = Effort::tiny;
  if (auto fine = session.report.check(); !fine) return fine;
  Expected<void> done;
  with_threads(arguments.options.threads, [&] {
    std::printf("%s; threads: %d, simd: %s\n", machine_description().c_str(), thread_count(),
                std::string(simd_level_name(best_simd_level())).c_str());
    done = measure_parts(session, arguments.only);
  });
  return done;
}

}  // namespace

void print_table(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  std::printf("\n%s\n%s", title.c_str(), text_table(rows).c_str());
  std::fflush(stdout);
}

void add_ao_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("ao", "Ambient occlusion from displacement fields");
  const auto arguments = std::make_shared<AoArguments>();
  add_bench_options(*command, arguments->options);
  command
      ->add_option("--only", arguments->only,
                   "Some parts: errors, surface, growth, many, lookups, frames, flicker [all]")
      ->type_name("PART,...")
      ->delimiter(',');
  command->add_flag("--tiny", arguments->tiny, "Check that all parts run; the figures mean nothing");
  command->callback([arguments, &run] { run = [arguments] { return run_ao(*arguments); }; });
}

}  // namespace tenebra::bench
