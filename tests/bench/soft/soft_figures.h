// The paper's own experiments on Tenebra's solvers: Mora et al. 2012, Figures 8 to 10.
#pragma once

#include <string>
#include <vector>

#include "bench/soft/soft_contest.h"

namespace tenebra::bench {

/// Figure 8: what one view costs, stage by stage, and what its trees are worth.
struct CostRow {
  std::string view;
  double peak_bytes = 0;
  double shaft = 0, init = 0, query = 0, irradiance = 0;  ///< shares of the stages' time, 0..1
  double total_ms = 0;
  double bsp_ms = 0;    ///< solver bsp alone, on the tiles of the fall-off
  double anew_ms = 0;   ///< the same with each query starting anew
  double fall_off = 0;  ///< anew / bsp
};
/// The fall-off is measured on one of `every` 8x8 tiles of the picture.
CostRow measure_cost(const SoftView& view, const Contest& contest, std::size_t every, Report& report);

/// Figure 9: the light's area grows from a square of 1 % of the diagonal.
struct AreaRow {
  double factor = 1;  ///< of the area
  Contest contest;
};
std::vector<AreaRow> measure_areas(const SoftView& view, const std::vector<double>& factors, int rounds,
                                   Report& report);

/// Figure 10: squares of 1 % of the diagonal in a horizontal grid around the first light, one after another.
struct LightsRow {
  std::size_t lights = 0;
  double time_ms = 0;     ///< of all
  double peak_bytes = 0;  ///< largest of the lights
};
std::vector<LightsRow> measure_lights(const SoftView& view, const std::vector<std::size_t>& counts,
                                      Report& report);

}  // namespace tenebra::bench
