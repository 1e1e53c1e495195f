#include "trade/trade_settings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "options/method_options.h"

namespace tenebra::viewer {

TradeSetting coarsest(const TradeAxes& axes) {
  return {axes.antialias.front(), axes.soft_errors.front(), axes.ao_errors.front()};
}

TradeSetting finest(const TradeAxes& axes) {
  return {axes.antialias.back(), axes.soft_errors.back(), axes.ao_errors.back()};
}

TradeSetting standard(const TradeAxes& axes) {
  TradeSetting setting = finest(axes);  // for what is no choice
  if (axes.antialias.size() > 1) setting.antialias = standard_antialias;
  if (axes.soft_errors.size() > 1) setting.soft_error = SoftShadowConfig{}.error_255;
  if (axes.ao_errors.size() > 1) setting.ao_error = AoConfig{}.error_255;
  return setting;
}

namespace {

template <class Value>
std::vector<TradeSetting> sweep_along(const TradeAxes& axes, const std::vector<Value>& values,
                                      Value TradeSetting::*member) {
  std::vector<TradeSetting> sweep(values.size(), coarsest(axes));
  for (std::size_t i = 0; i < values.size(); ++i) sweep[i].*member = values[i];
  return sweep;
}

}  // namespace

std::vector<TradeSetting> antialias_sweep(const TradeAxes& axes) {
  return sweep_along(axes, axes.antialias, &TradeSetting::antialias);
}
std::vector<TradeSetting> soft_sweep(const TradeAxes& axes) {
  return sweep_along(axes, axes.soft_errors, &TradeSetting::soft_error);
}
std::vector<TradeSetting> ao_sweep(const TradeAxes& axes) {
  return sweep_along(axes, axes.ao_errors, &TradeSetting::ao_error);
}

render::RenderSettings with_setting(render::RenderSettings settings, const TradeAxes& axes,
                                    const TradeSetting& choice) {
  if (axes.antialias.size() > 1) settings.antialias = choice.antialias;
  if (axes.soft_errors.size() > 1) settings.soft.error_255 = choice.soft_error;
  if (axes.ao_errors.size() > 1) settings.ao.error_255 = choice.ao_error;
  return settings;
}

std::vector<TradePoint> predicted_points(const TradeSweep& sweep) {
  const double base_ms = sweep.antialias.front().ms;  // all begin with the coarsest
  std::vector<TradePoint> points;
  for (const TradePoint& a : sweep.antialias)
    for (const TradePoint& s : sweep.soft)
      for (const TradePoint& o : sweep.ao)
        points.push_back({{a.setting.antialias, s.setting.soft_error, o.setting.ao_error},
                          std::max(a.ms + s.ms + o.ms - 2 * base_ms, 0.0),
                          std::hypot(a.error, s.error, o.error)});
  return points;
}

std::vector<std::size_t> pareto_front(std::span<const TradePoint> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].ms != points[b].ms ? points[a].ms < points[b].ms : points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
  return front;
}

std::vector<std::size_t> thinned(std::span<const TradePoint> points, std::span<const std::size_t> front,
                                 std::size_t most) {
  if (front.size() <= most || most < 2) return {front.begin(), front.end()};
  const auto place = [&](std::size_t i) { return std::log(std::max(points[i].ms, 1e-3)); };
  const double first = place(front.front()), last = place(front.back());
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < most; ++k) {
    const double wanted = first + (last - first) * static_cast<double>(k) / static_cast<double>(most - 1);
    const auto nearest = std::min_element(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(place(a) - wanted) < std::abs(place(b) - wanted);
    });
    if (kept.empty() || kept.back() != *nearest) kept.push_back(*nearest);
  }
  return kept;
}

}  // namespace tenebra::viewer
