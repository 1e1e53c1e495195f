// Ambient occlusion to an error that was asked for: rays against all triangles, few where the picture is
// smooth and more where it is not, and a filter over the results that keeps to one surface.
//
// Pixels are settled from coarse to fine: every fourth pixel in each direction (for small errors every
// second, or every one) casts rays ("looks"). In the next finer lattice only those pixels look whose
// neighbours cannot stand in for them: too few of these lie on the same surface, they differ, or something is
// close compared with the distance to them (as in an irradiance cache: Ward, Rubinstein and Clear 1988). The
// others take the weighted mean.
//
// The error is measured, not assumed: some pixels of each kind, chosen by a hash of their number, look with
// many rays. While they show a larger error than was asked for, the neighbours have to agree more closely, or
// pixels with few neighbours of their kind look again, whichever errs more.
#pragma once

#include <memory>

#include <tenebra/ao_config.h>
#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include "ao/adaptive/near_triangles.h"
#include "ao/adaptive/pixel_surfaces.h"

namespace tenebra::ao {

/// Where the work starts for a given error.
struct AdaptiveSettings {
  double error_255 = 2.5;   ///< RMS over the picture, in 1/255
  int rays = 64;            ///< of a pixel that looks
  int coarsest = 4;         ///< pixels from one of the first lattice to the next: 1, 2 or 4
  float difference = 0.1f;  ///< largest difference of neighbours that stand in for a pixel between them
  float closeness = 1.0f;   ///< largest distance to them, compared with what is near
};
AdaptiveSettings adaptive_settings(double error_255);

/// The input of a frame's occlusion.
struct AdaptiveScene {
  const AoFrame& frame;
  Casters& casters;
  const SeeThroughCasters& see_through;
  double reach;
  const RayKernels& kernels;
};

/// Lists and ray patterns are kept from frame to frame.
class AdaptiveOcclusion {
public:
  AdaptiveOcclusion();
  AdaptiveOcclusion(AdaptiveOcclusion&&) noexcept;
  AdaptiveOcclusion& operator=(AdaptiveOcclusion&&) noexcept;
  ~AdaptiveOcclusion();

  /// Fills `out` (one for each pixel; 1 where there is no receiver). Returns the estimate of its RMS error,
  /// in 1/255. The bits are the same for any number of threads. Fails with "stopped".
  Expected<double> compute(const AdaptiveScene& scene, const AdaptiveSettings& settings, std::span<float> out,
                           AoStats& stats, const StopFlag* stop);

  struct State;

private:
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::ao
