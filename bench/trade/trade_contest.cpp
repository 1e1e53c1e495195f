#include "bench/trade/trade_contest.h"

#include <algorithm>
#include <numeric>

#include <tenebra/threads.h>
#include "bench/ao/ao_race.h"
#include "bench/common/memory_meter.h"

namespace tenebra::bench {
namespace {

/// What the runs of one contestant have given.
class Entry {
public:
  Entry(const Contestant& contestant, const Turns& turns)
      : contestant_(contestant), turns_(turns), times_(turns.threads.size()) {
    point_.family = contestant.family, point_.setting = contestant.setting;
  }

  /// On each number of threads once, but where that has taken enough.
  Expected<void> take_turn() {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (!times_[i].empty() && std::accumulate(times_[i].begin(), times_[i].end(), 0.0) >= turns_.enough_ms)
        continue;
      Expected<double> ms = 0;
      with_threads(turns_.threads[i], [&] { ms = point_.times.empty() ? first_run() : run(); });
      if (!ms) return tl::unexpected(ms.error());
      times_[i].push_back(*ms);
      if (times_[i].size() == 1) point_.times.push_back({turns_.threads[i]});
      keep_errors();
    }
    return {};
  }

  TradePoint point() const {
    TradePoint point = point_;
    for (std::size_t i = 0; i < times_.size(); ++i) point.times[i].ms = median(times_[i]);
    return point;
  }

private:
  Expected<double> run() const {
    if (contestant_.prepare) contestant_.prepare();
    return contestant_.run();
  }
  Expected<double> first_run() {
    if (contestant_.forget) contestant_.forget();
    const MemoryMeter meter;
    auto ms = run();
    point_.mb = contestant_.made_mb + meter.mb();
    return ms;
  }
  void keep_errors() {
    const std::vector<double> errors = contestant_.errors();
    point_.errors.resize(errors.size(), 0);
    for (std::size_t k = 0; k < errors.size(); ++k) point_.errors[k] = std::max(point_.errors[k], errors[k]);
  }

  const Contestant& contestant_;
  const Turns& turns_;
  TradePoint point_;
  std::vector<std::vector<double>> times_;  // by number of threads
};

}  // namespace

std::function<Expected<double>()> clocked(std::function<Expected<void>()> work) {
  return [work = std::move(work)]() -> Expected<double> {
    CostClock clock;
    if (auto done = work(); !done) return tl::unexpected(done.error());
    return clock.ms();
  };
}

Expected<std::vector<TradePoint>> take_turns(const std::vector<Contestant>& contestants, const Turns& turns) {
  std::vector<Entry> entries;
  for (const Contestant& c : contestants) entries.emplace_back(c, turns);
  for (int round = 0; round < turns.rounds; ++round) {
    for (Entry& entry : entries)
      if (auto done = entry.take_turn(); !done) return tl::unexpected(done.error());
  }
  std::vector<TradePoint> points;
  for (const Entry& entry : entries) points.push_back(entry.point());
  return points;
}

}  // namespace tenebra::bench
