// Soft shadows the simple way: hard masks of a few points of the light, added up.
#pragma once

#include <span>
#include <vector>

#include "light_samples.h"
#include "shadow/mask.h"
#include "soft_views.h"

namespace tenebra::bench {

/// `count` stratified points of the light, each with a mask of its own. The same points for all pixels: the
/// penumbra has `count` steps instead of noise.
class LightPointMasks {
public:
  /// `count`: a power of two.
  LightPointMasks(const AreaLight& light, std::size_t count);

  /// Irradiance for radiance 1. On all threads.
  void trace(const SoftView& view, ShadowTracer& tracer, std::span<float> irradiance);

private:
  LightSamples points_;
  ShadowMask mask_;
};

}  // namespace tenebra::bench
