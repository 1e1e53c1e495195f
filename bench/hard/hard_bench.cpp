// tenebra-bench hard: the default hard shadows beside Embree's rays; growth and steadiness.
#include <array>
#include <memory>

#include "base/fail.h"
#include "bench/hard/hard_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{BenchPart<HardSession>{"frames", measure_hard_frames},
                           BenchPart<HardSession>{"whole", measure_hard_whole},
                           BenchPart<HardSession>{"sun", measure_hard_sun},
                           BenchPart<HardSession>{"cut", measure_hard_cut},
                           BenchPart<HardSession>{"growth", measure_hard_growth},
                           BenchPart<HardSession>{"variance", measure_hard_variance}};
const std::span<const BenchPart<HardSession>> all_parts(parts);

std::vector<LastLine> last_lines(const HardHeadline& h) {
  return {{"dynamic_geomean", h.dynamic_geomean, 3},
          {"static_geomean", h.static_geomean, 3},
          {"dynamic_worst", h.dynamic_worst, 3},
          {"static_worst", h.static_worst, 3},
          {"growth_static_1.8m", h.growth_static_1_8m, 3},
          {"p99_over_median", h.p99_over_median, 3},
          {"whole_moved_geomean", h.whole_moved_geomean, 3},
          {"whole_moved_worst", h.whole_moved_worst, 3},
          {"whole_static_geomean", h.whole_static_geomean, 3},
          {"whole_static_worst", h.whole_static_worst, 3},
          {"whole_first_moved_geomean", h.first_moved_geomean, 3},
          {"whole_first_moved_worst", h.first_moved_worst, 3},
          {"whole_first_static_geomean", h.first_static_geomean, 3},
          {"whole_first_static_worst", h.first_static_worst, 3},
          {"sun_geomean", h.sun_geomean, 3},
          {"sun_worst", h.sun_worst, 3},
          {"cut_moved_geomean", h.cut_moved_geomean, 3},
          {"cut_moved_worst", h.cut_moved_worst, 3}};
}

/// `simd` is the name of the level that both contestants are kept to.
Expected<void> measure(const PartsArguments& arguments, const std::string& simd) {
  const auto level = simd_level_from_name(simd);
  if (!level || (*level != SimdLevel::automatic && !simd_level_supported(*level)))
    return base::fail(
        "--simd: found {}, expected auto or a level of this machine: scalar, sse4, avx2, avx512", simd);
  HardSession session(arguments);
  session.simd = *level;
  if (auto done = measure_and_write(arguments, all_parts, session, *level); !done) return done;
  print_end("hard", session.skipped, last_lines(session.headline));
  return {};
}

constexpr const char* footer =
    "dynamic, static: the mask of one light from given visible points, with and without the time to build\n"
    "the tree. whole_moved: from triangle ids to the masks of all lights of a frame whose triangles\n"
    "moved since the frame before (points, tiles, rays, build or refit, trace; Embree at the best of\n"
    "its builds, packets of 4, 8 and 16, and both directions of rays). whole_static: the same where\n"
    "nothing moved, Embree's trees built before at medium and high quality. Over twelve frames of BART\n"
    "with all their lights, and city 30, 150 and 250 with its point light. whole_first: the first light\n"
    "of each frame alone. sun: as whole, with city's sun, and in BART with one from (0.1, 1, 0.5), over\n"
    "moved and static together. cut_moved: as whole_moved, with the triangles of robots cut in sixteen\n"
    "and those of city in four, in place.";

}  // namespace

void add_hard_command(CLI::App& program, Run& run) {
  const auto simd = std::make_shared<std::string>("auto");
  CLI::App& command = add_parts_command(
      program, run, {"hard", "Hard shadows compared with Embree's rays", footer}, part_names(all_parts),
      [simd](const PartsArguments& arguments) { return measure(arguments, *simd); });
  command.add_option("--simd", *simd, "Vector instructions that both contestants use [auto]")
      ->type_name("LEVEL");
}

}  // namespace tenebra::bench
