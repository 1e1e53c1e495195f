// What see-through surfaces let pass of a sun.
#pragma once

#include <span>
#include <vector>

#include <tenebra/queries.h>
#include <tenebra/tint.h>

namespace tenebra::sun {

/// Of the points of one list. Refers to `surfaces` and `geometry`.
class Glass {
public:
  Glass(const SeeThroughSurfaces& surfaces, const Geometry& geometry, const QueryPoints& points);

  /// Multiplies the shares of the light that reach each point by the luminance of what is let pass on the way
  /// to `light`, crossed as TintTracer says: of a disc its centre. False: stopped.
  bool dim(const ShadowLight& light, std::span<float> shares, const StopFlag* stop);

private:
  const SeeThroughSurfaces& surfaces_;
  const Geometry& geometry_;
  VisiblePoints points_;
  std::vector<std::size_t> pixels_;   ///< where each point stands in points_
  std::vector<std::size_t> numbers_;  ///< the point that stands at a pixel
  ShadowMask mask_;
  TintTracer tracer_;
  TintConfig config_;
  TintMask tints_;
};

}  // namespace tenebra::sun
