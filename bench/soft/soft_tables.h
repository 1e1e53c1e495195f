// What `tenebra-bench soft` prints and plots in the end.
#pragma once

#include <string>
#include <vector>

#include "bench/soft/soft_contest.h"
#include "bench/soft/soft_error_race.h"
#include "bench/soft/soft_large.h"
#include "bench/soft/soft_trees.h"

namespace tenebra::bench {

struct TreeRow {
  std::string view;
  double default_ms = 0;
  TreeCost cost;  ///< with solver bsp instead
};

struct SoftResults {
  std::vector<Contest> contests;
  std::vector<TreeRow> trees;
  std::vector<ErrorRace> races, sun_races;
  std::vector<ErrorRace> sized_races;  ///< with lights of other sizes
  std::vector<LargeRow> large;
  std::vector<GrownLight> grown;
  std::vector<std::string> skipped;  ///< what could not be measured, each a sentence with its reason
};

/// Readable tables, one per experiment.
std::string soft_tables(const SoftResults& results);
void add_soft_plots(const SoftResults& results, Report& report);

/// The lines that a script reads, "soft.eq_geomean: 7.1" and so on; "not measured" where nothing was.
/// Speed-ups over the counted views, errors over all views.
std::string soft_summary(const SoftResults& results);

}  // namespace tenebra::bench
