// tenebra-bench ao: errors, speed, growth, memory and steadiness of ambient occlusion from displacement
// fields.
#include <fmt/core.h>
#include <array>
#include <cstdio>

#include "bench/ao/ao_session.h"
#include "bench/common/bench_parts.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<AoSession>{"errors", measure_errors},   BenchPart<AoSession>{"surface", measure_surface},
    BenchPart<AoSession>{"growth", measure_growth},   BenchPart<AoSession>{"many", measure_many},
    BenchPart<AoSession>{"lookups", measure_lookups}, BenchPart<AoSession>{"frames", measure_frames},
    BenchPart<AoSession>{"flicker", measure_flicker}};
const std::span<const BenchPart<AoSession>> all_parts(parts);

void print_headlines(const AoHeadline& h) {
  std::printf("\n");
  print_headline("ao.outside_rms_255", h.outside_rms_255, 2);
  print_headline("ao.paper_rms_255", h.paper_rms_255, 2);
  print_headline("ao.inside_rms_255", h.inside_rms_255, 2);
  print_headline("ao.surface_rms_255", h.surface_rms_255, 2);
  print_headline("ao.lookup_speedup", h.lookup_speedup, 1);
  print_headline("ao.frame_speedup", h.frame_speedup, 1);
  print_headline("ao.frame_speedup_half", h.frame_speedup_half, 1);
  print_headline("ao.growth_1k_to_1m", h.growth_1k_to_1m, 1);
  print_headline("ao.bytes", h.bytes, 0);
}

Expected<void> write_files(const AoSession& session, const std::vector<std::string>& settings) {
  if (auto written = session.report.write(settings); !written) return written;
  const std::filesystem::path& csv = session.options.csv;
  if (csv.empty()) return {};
  for (const auto& [name, picture] : session.pictures) {
    const auto path = csv.parent_path() / fmt::format("{}_{}.png", csv.stem().string(), name);
    if (auto written = base::write_png(path, picture); !written) return written;
  }
  return {};
}

Expected<void> measure(const PartsArguments& arguments) {
  AoSession session{
      .options = arguments.options, .effort = arguments.effort(), .report = Report(arguments.options.csv)};
  if (auto done = measure_parts(arguments, all_parts, session); !done) return done;
  if (auto written = write_files(session, parts_settings(arguments)); !written) return written;
  if (!session.notes.empty()) std::printf("\n");
  for (const std::string& note : session.notes) std::printf("note: %s.\n", note.c_str());
  print_headlines(session.headline);
  return {};
}

}  // namespace

void add_ao_command(CLI::App& program, Run& run) {
  add_parts_command(program, run, {"ao", "Ambient occlusion from displacement fields"}, part_names(all_parts),
                    measure);
}

}  // namespace tenebra::bench
