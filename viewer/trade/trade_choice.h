// Which settings there are to choose from, and the one that fits a time or an error.
#pragma once

#include "trade/trade_run.h"

namespace tenebra::viewer {

/// Settings that the user has given are no longer to be chosen.
struct TradeGiven {
  bool antialias = false, soft_error = false, ao_error = false;
};

/// What frames with these settings have to choose from.
TradeAxes axes_of(const render::RenderSettings& settings, const TradeGiven& given);

/// The time that a frame in the middle of the animation is expected to take: that of the frames that were
/// tried, times the time spread, as those that were not may have more to draw. Milliseconds.
double promised_ms(const TradeResult& result, const TradedSetting& setting);
/// The error that frames which were not tried are expected to keep to: that of the worst of those that were,
/// times the spread, and a fifth more. Levels of 255; 0 for what is the finest.
double promised_error(const TradeResult& result, const TradedSetting& setting);

/// The most exact setting whose frame is expected to take no longer than the budget; null: none is.
const TradedSetting* within_budget(const TradeResult& result, double budget_ms);
/// The quickest setting that is off by no more; null: none is as exact.
const TradedSetting* within_error(const TradeResult& result, double error);

}  // namespace tenebra::viewer
