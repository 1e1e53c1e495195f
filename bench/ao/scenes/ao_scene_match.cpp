#include "bench/ao/scenes/ao_scene_match.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tenebra::bench {
namespace {

/// `share` of the way from a to b in logarithms.
double between(double a, double b, double share) {
  return std::exp(std::log(a) + share * (std::log(b) - std::log(a)));
}

std::optional<ErrorMatch> match(const CostCurve& curve, double rms) {
  for (std::size_t i = 0; i < curve.costs.size(); ++i) {
    const RayCost& there = curve.costs[i];
    if (!(there.rms <= rms)) continue;
    if (i == 0 || !(there.rms > 0)) return ErrorMatch{curve.name, double(there.rays), there.ms};
    const RayCost& before = curve.costs[i - 1];  // rms above what is asked for
    const double share = std::log(before.rms / rms) / std::log(before.rms / there.rms);
    return ErrorMatch{curve.name, between(before.rays, there.rays, share),
                      between(before.ms, there.ms, share)};
  }
  return std::nullopt;
}

}  // namespace

ErrorMatch match_error(std::span<const CostCurve> curves, double rms) {
  std::optional<ErrorMatch> best;
  for (const CostCurve& curve : curves) {
    const auto found = match(curve, rms);
    if (found && (!best || found->ms < best->ms)) best = found;
  }
  if (best) return *best;
  ErrorMatch bound{.bound = true};
  for (const CostCurve& curve : curves) {
    if (curve.converges && !curve.costs.empty() && curve.costs.back().ms > bound.ms)
      bound = {curve.name, double(curve.costs.back().rays), curve.costs.back().ms, true};
  }
  return bound;
}

bool reaches(std::span<const CostCurve> curves, double rms) {
  return std::any_of(curves.begin(), curves.end(), [&](const CostCurve& curve) {
    return std::any_of(curve.costs.begin(), curve.costs.end(),
                       [&](const RayCost& cost) { return cost.rms <= rms; });
  });
}

}  // namespace tenebra::bench
