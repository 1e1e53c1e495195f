// The settings that trade time for error, and which of them are worth having.
#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"

namespace tenebra::viewer {

/// Errors in 1/255, as the options of the same names have them.
struct TradeSetting {
  int antialias = 1;
  double soft_error = 0;
  double ao_error = 0;
  bool operator==(const TradeSetting&) const = default;
};

/// What can be chosen, from the coarsest to the finest: at least one value each. One alone is no choice: the
/// user gave it, or the frames have nothing that it changes.
struct TradeAxes {
  std::vector<int> antialias{1};
  std::vector<double> soft_errors{0};
  std::vector<double> ao_errors{0};
};

TradeSetting coarsest(const TradeAxes& axes);
TradeSetting finest(const TradeAxes& axes);
/// The setting of a user who chooses nothing.
TradeSetting standard(const TradeAxes& axes);

/// The settings that differ from the coarsest along one axis at most, value after value.
std::vector<TradeSetting> antialias_sweep(const TradeAxes& axes);
std::vector<TradeSetting> soft_sweep(const TradeAxes& axes);
std::vector<TradeSetting> ao_sweep(const TradeAxes& axes);

/// `settings` with this choice; what is no choice stays as it was.
render::RenderSettings with_setting(render::RenderSettings settings, const TradeAxes& axes,
                                    const TradeSetting& choice);

/// What a setting costs and how far off it is.
struct TradePoint {
  TradeSetting setting;
  double ms = 0;     ///< of a frame
  double error = 0;  ///< RMS over the picture, levels of 255
};

/// The measured points of an axis's values, with the others at their coarsest.
struct TradeSweep {
  std::vector<TradePoint> antialias, soft, ao;  ///< errors against the last of each
};

/// Points of all settings: differences of time add up, and so do squares of errors.
std::vector<TradePoint> predicted_points(const TradeSweep& sweep);

/// Indices of the points that no other beats in one of time and error without being worse in the other, from
/// the quickest to the most exact. Of equal ones the first.
std::vector<std::size_t> pareto_front(std::span<const TradePoint> points);

/// At most `most` of `front`, its ends among them, spread evenly over the logarithm of time.
std::vector<std::size_t> thinned(std::span<const TradePoint> points, std::span<const std::size_t> front,
                                 std::size_t most);

}  // namespace tenebra::viewer
