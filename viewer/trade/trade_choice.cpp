#include "trade/trade_choice.h"

#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr double finest_ao_error = 0.5;
/// The spread is that of a coarse setting; by how much errors of others exceeded it was measured: 1.19 times
/// at most on the views of tools/trade_views.txt.
constexpr double error_slack = 1.2;

}  // namespace

TradeAxes axes_of(const render::RenderSettings& settings, const TradeGiven& given) {
  TradeAxes axes;
  if (!given.antialias) axes.antialias = {1, 2, 4, 8, 16};
  const bool soft = settings.shadows == render::ShadowMode::soft && settings.soft_points == 0;
  if (soft && !given.soft_error) axes.soft_errors = {8, 4, 2, 1, 0.5, 0};
  if (settings.ao.mode == AoMode::adaptive && !given.ao_error)
    axes.ao_errors = {8, 5, 2.5, 1, finest_ao_error};
  return axes;
}

double promised_ms(const TradeResult& result, const TradedSetting& setting) {
  return setting.point.ms * result.time_spread;
}

double promised_error(const TradeResult& result, const TradedSetting& setting) {
  return setting.worst_error * result.spread * error_slack;
}

const TradedSetting* within_budget(const TradeResult& result, double budget_ms) {
  const TradedSetting* found = nullptr;
  for (const TradedSetting& setting : result.measured)
    if (promised_ms(result, setting) <= budget_ms &&
        (found == nullptr || setting.point.error < found->point.error))
      found = &setting;
  return found;
}

const TradedSetting* within_error(const TradeResult& result, double error) {
  const TradedSetting* found = nullptr;
  for (const TradedSetting& setting : result.measured)
    if (promised_error(result, setting) <= error && (found == nullptr || setting.point.ms < found->point.ms))
      found = &setting;
  return found;
}

}  // namespace tenebra::viewer
