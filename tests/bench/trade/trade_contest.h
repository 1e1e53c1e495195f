// Settings measured in turn, round by round, so that what else the machine does meets all alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "bench/trade/trade_table.h"

namespace tenebra::bench {

/// One setting that takes part.
struct Contestant {
  std::string family, setting;
  int rounds = 1;
  std::function<Expected<double>()> run;        ///< once: its milliseconds
  std::function<std::vector<double>()> errors;  ///< of what the last run gave
  std::function<void()> prepare{};              ///< before each run, not timed
};

/// A run that takes as long as the clock says.
std::function<Expected<double>()> clocked(std::function<Expected<void>()> work);

/// Medians of the times, largest errors of the rounds.
Expected<std::vector<TradePoint>> take_turns(const std::vector<Contestant>& contestants);

}  // namespace tenebra::bench
