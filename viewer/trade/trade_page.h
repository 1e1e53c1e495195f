// The results of `tenebra trade`, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "trade/trade_run.h"

namespace tenebra::viewer {

/// What the texts say besides the result.
struct TradeHeading {
  std::string scene;
  std::string machine;
  std::string command;  ///< what all settings share: "tenebra render scene.glb --shadows soft"
  int width = 0, height = 0;
  int threads = 0;  ///< 0: all cores
};

/// The options that choose `setting` among the axes: "--antialias 4 --soft-error 2"; "" if there is nothing
/// to choose.
std::string options_of(const TradeAxes& axes, const TradeSetting& setting);

/// A table of the Pareto front, from the quickest to the most exact.
std::string trade_table(const TradeResult& result);
/// All that was measured; points of the front are marked.
std::string trade_json(const TradeHeading& heading, const TradeResult& result);
/// The front as a self-contained page: a plot, a table, crops of each setting beside the finest.
Expected<std::string> trade_page(const TradeHeading& heading, const TradeResult& result);

}  // namespace tenebra::viewer
