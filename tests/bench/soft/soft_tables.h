// What `tenebra-bench soft` prints and plots in the end.
#pragma once

#include <string>
#include <vector>

#include "bench/soft/soft_error_race.h"
#include "bench/soft/soft_figures.h"
#include "bench/soft/soft_life.h"

namespace tenebra::bench {

struct SoftResults {
  std::vector<Contest> contests;
  std::vector<ErrorRace> races, sun_races;
  std::vector<CostRow> costs;
  std::vector<AreaRow> areas;
  std::vector<LightsRow> lights;
  std::vector<LifeRow> life;
  std::string growth_view;           ///< on which areas, lights and life were measured
  std::vector<std::string> skipped;  ///< what could not be measured, each a sentence with its reason
};

/// Readable tables, one per experiment.
std::string soft_tables(const SoftResults& results);
void add_soft_plots(const SoftResults& results, Report& report);

/// The lines that a script reads, "soft.eq_geomean: 7.1" and so on; nan where nothing was measured. Speed-ups
/// over the counted views, errors and memory over all views.
std::string soft_summary(const SoftResults& results);

}  // namespace tenebra::bench
