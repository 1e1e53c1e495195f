// The fairer opponent: shaft culling decides the groups of points that are plainly lit or plainly dark, and
// Embree's shadow rays are traced for the rest only.
#pragma once

#include "bench/soft/soft_embree.h"
#include "bench/soft/soft_quality.h"
#include "bench/soft/soft_views.h"
#include "soft/groups/point_groups.h"
#include "soft/shafts/shafts.h"

namespace tenebra::bench {

/// Buffers kept from run to run.
class ShaftedSampler {
public:
  /// Irradiance of all pixels: Tenebra's own groups and shafts, the closed form for the lit points, `sampler`
  /// for the rest.
  void trace(const SoftView& view, const EmbreeScene& casters, std::span<const SampledReceiver> receivers,
             const SoftSampler& sampler, std::span<float> irradiance);

  /// Part of the visible points that went to Embree in the last call, 0..1.
  double traced_part() const { return traced_part_; }

private:
  soft::PointGroups groups_;
  soft::ShaftCuller culler_;
  std::vector<std::uint8_t> wanted_;
  double traced_part_ = 0;
};

}  // namespace tenebra::bench
