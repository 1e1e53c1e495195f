// The time that an opponent with a choice of rays, filters and resolutions needs to reach another's error.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tenebra::bench {

struct RayCost {
  int rays = 0;
  double rms = 0;  ///< in 1/255
  double ms = 0;
};
/// One filter at one resolution, by ascending counts of rays.
struct CostCurve {
  std::string name;
  bool converges = false;  ///< more rays leave less error, down to none
  std::vector<RayCost> costs;
};

struct ErrorMatch {
  std::string name;  ///< of the curve
  double rays = 0, ms = 0;
  bool bound = false;  ///< no count that was tried reaches the error: it takes this long or longer
};

/// The least time that leaves at most `rms`. Between two counts the time is interpolated in logarithms, of
/// the error as of the time; below the fewest rays it is theirs. Where all curves miss, the time of the most
/// rays on the curve that converges is a lower bound.
ErrorMatch match_error(std::span<const CostCurve> curves, double rms);

/// Whether some count of rays on some curve leaves at most `rms`.
bool reaches(std::span<const CostCurve> curves, double rms);

}  // namespace tenebra::bench
