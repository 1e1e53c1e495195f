// One run of `tenebra-bench sun`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <vector>

#include "bench/common/bench_session.h"

namespace tenebra::bench {

struct SunSession : BenchSession {
  using BenchSession::BenchSession;

  std::vector<double> ratios, robust_ratios;       ///< one for each model and sky
  std::optional<double> wrong_ours, wrong_embree;  ///< answers, of those looked at
  double checked = 0;                              ///< answers looked at
  std::optional<double> year_s;                    ///< of the whole year
};

// The parts.
Expected<void> measure_houses(SunSession& session);
Expected<void> measure_city(SunSession& session);
Expected<void> measure_terrain(SunSession& session);
Expected<void> measure_year(SunSession& session);  ///< 4,400 suns on the city

}  // namespace tenebra::bench
