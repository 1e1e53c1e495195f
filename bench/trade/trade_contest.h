// Settings measured in turn, round by round, so that other load of the machine affects all alike.
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
  std::function<Expected<double>()> run;        ///< once: its milliseconds
  std::function<std::vector<double>()> errors;  ///< of what the last run gave
  std::function<void()> prepare{};              ///< before each run, not timed
  std::function<void()> forget{};  ///< before the first: gives back the memory that earlier runs have left it
  double made_mb = 0;              ///< of what was made for it beforehand
};

/// How often each setting is run.
struct Turns {
  std::vector<int> threads;  ///< numbers of threads, one after the other
  int rounds = 1;
  double enough_ms = 0;  ///< a setting whose runs took this long together is not run again
};

/// A run that takes as long as the clock says.
std::function<Expected<double>()> clocked(std::function<Expected<void>()> work);

/// Medians of the times, largest errors of the rounds; memory of the first run, on the first number of
/// threads.
Expected<std::vector<TradePoint>> take_turns(const std::vector<Contestant>& contestants, const Turns& turns);

}  // namespace tenebra::bench
