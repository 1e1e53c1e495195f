// What an answer is measured against: the light as it would be seen with nothing in its way, and how far an
// answer is off. Closed forms, written apart from those of src/soft.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/soft_shadows.h>
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

/// The light from one point, nothing in its way.
struct Unoccluded {
  double fraction = 0;    ///< part of the light's area above the receiver's plane
  double irradiance = 0;  ///< for radiance 1
};

/// `normal`: shading normal; `geometric`: normal of the receiver's plane on the seen side. Both unit.
/// Irradiance: the contour integral of Nishita and Nakamae (1985).
Unoccluded unoccluded(const AreaLight& light, const glm::dvec3& point, const glm::dvec3& normal,
                      const glm::dvec3& geometric);

/// The exact answer of one view, and what follows from it.
struct Truth {
  SoftMask mask;
  double white = 1;  ///< 99.9th percentile of the irradiance of the pixels that see a triangle
  std::vector<std::uint8_t>
      penumbra;  ///< 1: sees a part of what it would see of the light with nothing in its way
  std::size_t penumbra_count = 0;
};

/// Derives the rest from the mask.
void finish_truth(const BenchFrame& frame, const AreaLight& light, Truth& truth);

/// Root of the mean square and largest error of the irradiance, in 1/255 of white; what is not finite errs
/// without bound.
struct SoftErrors {
  double rms = 0, worst = 0;
};
enum class Where { penumbra, everywhere };
SoftErrors errors_255(const Truth& truth, std::span<const float> irradiance, Where where);

/// Over the penumbra, and over all pixels.
double penumbra_rmse_255(const Truth& truth, std::span<const float> irradiance);
double largest_error_255(const Truth& truth, std::span<const float> irradiance);

}  // namespace tenebra::bench
