#include "bench/trade/trade_contest.h"

#include <algorithm>

#include "bench/ao/ao_race.h"

namespace tenebra::bench {

std::function<Expected<double>()> clocked(std::function<Expected<void>()> work) {
  return [work = std::move(work)]() -> Expected<double> {
    CostClock clock;
    if (auto done = work(); !done) return tl::unexpected(done.error());
    return clock.ms();
  };
}

Expected<std::vector<TradePoint>> take_turns(const std::vector<Contestant>& contestants) {
  std::vector<TradePoint> points;
  int rounds = 0;
  for (const Contestant& c : contestants) {
    points.push_back({c.family, c.setting, 0, {}});
    rounds = std::max(rounds, c.rounds);
  }
  std::vector<std::vector<double>> times(contestants.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const Contestant& c = contestants[i];
      if (round >= c.rounds) continue;
      if (c.prepare) c.prepare();
      const auto ms = c.run();
      if (!ms) return tl::unexpected(ms.error());
      times[i].push_back(*ms);
      const std::vector<double> errors = c.errors();
      points[i].errors.resize(errors.size(), 0);
      for (std::size_t k = 0; k < errors.size(); ++k)
        points[i].errors[k] = std::max(points[i].errors[k], errors[k]);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].ms = median(times[i]);
  return points;
}

}  // namespace tenebra::bench
