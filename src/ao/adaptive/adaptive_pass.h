// Ambient occlusion with an error that was asked for: rays against all triangles, few where the picture is
// smooth and more where it is not, and a guided filter over what they find.
//
// Pixels are settled from coarse to fine: all of a lattice of every fourth pixel in each direction look for
// themselves. Of the next finer lattice only those do that their neighbours cannot speak for: where too few
// of them lie on the same surface, where these differ, or where something is near by the measure of the
// distance to them (as in an irradiance cache: Ward, Rubinstein and Clear 1988). The others take the weighted
// mean.
//
// The error is measured, not assumed: some pixels of each kind, chosen by a hash of their number, look with
// many rays. While they say that the picture errs by more than was asked for, the neighbours have to agree
// better, or pixels with few neighbours of their kind look again, whichever errs more.
#pragma once

#include <tenebra/ao_config.h>
#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include "ao/adaptive/near_triangles.h"
#include "ao/adaptive/pixel_surfaces.h"

namespace tenebra::ao {

/// Where the work starts for an error.
struct AdaptiveSettings {
  double error_255 = 2.5;   ///< RMS over the picture, in 1/255
  int rays = 64;            ///< of a pixel that looks
  int coarsest = 4;         ///< pixels from one of the first lattice to the next: 1, 2 or 4
  float difference = 0.1f;  ///< of neighbours that speak for what lies between them, at most
  float closeness = 1.0f;   ///< of the distance to them, by what is near: at most
};
AdaptiveSettings adaptive_settings(double error_255);

/// What a frame's occlusion works with.
struct AdaptiveScene {
  const AoFrame& frame;
  Occluders& occluders;
  const SeeThroughOccluders& see_through;
  double reach;
  const AoKernels& kernels;
};

/// Fills `out` (one for each pixel; 1 where there is no receiver). Returns the estimate of its RMS error, in
/// 1/255. The bits are the same for any number of threads. Fails with "stopped".
Expected<double> adaptive_occlusion(const AdaptiveScene& scene, const AdaptiveSettings& settings,
                                    std::span<float> out, AoStats& stats, const StopFlag* stop);

}  // namespace tenebra::ao
