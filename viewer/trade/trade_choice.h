// Which settings there are to choose from, and the one that fits a time or an error.
#pragma once

#include <functional>

#include "trade/trade_run.h"

namespace tenebra::viewer {

/// Settings that the user has given are no longer to be chosen.
struct TradeGiven {
  bool antialias = false, soft_error = false, ao_error = false;
};

/// What frames with these settings have to choose from.
TradeAxes axes_of(const render::RenderSettings& settings, const TradeGiven& given);

/// The error that frames which were not tried are expected to keep to: that of the worst of those that were,
/// times the spread, and a fifth more. Levels of 255; 0 for what is the finest.
double promised_error(const TradeResult& result, const TradedSetting& setting);

/// Times a setting on frames that were not tried. Milliseconds.
using TimeSetting = std::function<Expected<double>(const TradePoint&)>;

/// A setting of the front, and what a frame takes with it.
struct TimedSetting {
  const TradedSetting* setting = nullptr;
  double ms = 0;
};
/// The most exact setting of the front that keeps to the budget, while the next finer one does not; both are
/// timed anew, as frames that were not tried may have more to draw, or less. Null, and the time of the
/// quickest: none keeps to it. The budget may be exceeded by a tenth, and what takes less than the budget has
/// to be found: a setting keeps to it up to the middle between the two.
Expected<TimedSetting> within_budget(const TradeResult& result, double budget_ms, const TimeSetting& time);
/// The quickest setting that is off by no more; null: none is as exact.
const TradedSetting* within_error(const TradeResult& result, double error);

}  // namespace tenebra::viewer
