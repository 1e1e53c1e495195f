#include "trade/trade_choice.h"

#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr double finest_ao_error = 0.5;
/// The spread is that of a coarse setting; by how much errors of others exceeded it was measured: 1.19 times
/// at most on the views of tools/trade_views.txt.
constexpr double error_slack = 1.2;
constexpr double kept_up_to = 1.05;  ///< of the budget

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

double promised_error(const TradeResult& result, const TradedSetting& setting) {
  return setting.worst_error * result.spread * error_slack;
}

Expected<TimedSetting> within_budget(const TradeResult& result, double budget_ms, const TimeSetting& time) {
  const double limit_ms = kept_up_to * budget_ms;
  const auto setting = [&](std::size_t i) -> const TradedSetting& {
    return result.measured[result.front[i]];
  };
  std::size_t i = 0;  // the most exact that fits by the frames that were tried
  while (i + 1 < result.front.size() && setting(i + 1).point.ms <= limit_ms) ++i;
  auto ms = time(setting(i).point);
  if (!ms) return tl::unexpected(ms.error());
  const bool as_expected = *ms <= limit_ms;
  while (*ms > limit_ms && i > 0) {
    ms = time(setting(--i).point);
    if (!ms) return tl::unexpected(ms.error());
  }
  while (as_expected && i + 1 < result.front.size()) {
    const auto finer_ms = time(setting(i + 1).point);
    if (!finer_ms) return tl::unexpected(finer_ms.error());
    if (*finer_ms > limit_ms) break;
    ms = finer_ms;
    ++i;
  }
  return TimedSetting{*ms <= limit_ms ? &setting(i) : nullptr, *ms};
}

const TradedSetting* within_error(const TradeResult& result, double error) {
  const TradedSetting* found = nullptr;
  for (const TradedSetting& setting : result.measured)
    if (promised_error(result, setting) <= error && (found == nullptr || setting.point.ms < found->point.ms))
      found = &setting;
  return found;
}

}  // namespace tenebra::viewer
