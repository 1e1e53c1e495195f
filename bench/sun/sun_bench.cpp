// tenebra-bench sun: hours of sun on a building, beside Embree's packets of coherent rays.
#include <algorithm>
#include <array>

#include "bench/sun/sun_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<SunSession>{"houses", measure_houses}, BenchPart<SunSession>{"city", measure_city},
    BenchPart<SunSession>{"terrain", measure_terrain}, BenchPart<SunSession>{"year", measure_year}};

std::vector<LastLine> last_lines(const SunSession& s) {
  std::optional<double> geomean, worst, robust;
  if (!s.ratios.empty()) {
    geomean = geometric_mean(s.ratios), worst = *std::ranges::max_element(s.ratios);
    robust = geometric_mean(s.robust_ratios);
  }
  return {{"year_s", s.year_s, 1},
          {"wrong_tenebra", s.wrong_ours, 0},
          {"wrong_embree", s.wrong_embree, 0},
          {"checked", s.checked > 0 ? std::optional(s.checked) : std::nullopt, 0},
          {"ratio_robust_geomean", robust, 3},
          {"ratio_geomean", geomean, 3},
          {"ratio_worst", worst, 3}};
}

constexpr const char* footer =
    "Sums of minutes that points see the sun, as `tenebra sun` counts them: on the walls and roofs of some "
    "200\n"
    "houses, on the city, and on a tenth of a terrain of a million triangles; suns of a day each ten "
    "minutes, "
    "and\n"
    "of a year each hour of every fifteenth day. ratio: our time, trees and checks of the input included, "
    "over\n"
    "Embree's without its trees: float, tree of high quality, points that face away left out, packets of "
    "16, 8,\n"
    "4 or 1, of neighbouring points or suns, suns or points in the inner loop, points as given or along a "
    "curve; the\n"
    "quickest of them in a trial counts. ratio_robust: over its robust traversal. Both run in turns, "
    "medians\n"
    "count. wrong: answers other than the exact oracle's, of those that were checked. year_s: 4,400 suns on\n"
    "a point of each of the city's 88,814 faces.";

}  // namespace

void add_sun_command(CLI::App& program, Run& run) {
  add_session_command<SunSession>(
      program, run, {"sun", "Hours of sun on faces, compared with Embree's packets of rays", footer}, parts,
      last_lines);
}

}  // namespace tenebra::bench
