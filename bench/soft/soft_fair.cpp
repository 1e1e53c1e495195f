#include "bench/soft/soft_fair.h"

#include <algorithm>

namespace tenebra::bench {

void ShaftedSampler::trace(const SoftView& view, const EmbreeScene& casters,
                           std::span<const SampledReceiver> receivers, const SoftSampler& sampler,
                           std::span<float> irradiance) {
  const BenchFrame& frame = view.frame;
  const SoftShadowConfig config;
  soft::group_points(frame.points, frame.triangles(), view.light, config.grouping, groups_);
  wanted_.assign(receivers.size(), 0);
  std::fill(irradiance.begin(), irradiance.end(), 0.0f);
  const auto take_group = [&](const soft::GroupDecision& decision) {
    for (const std::uint32_t pixel : groups_.pixels_of(*decision.group)) {
      if (decision.kind == soft::GroupClass::mixed) wanted_[pixel] = 1;
      if (decision.kind != soft::GroupClass::lit) continue;
      const SampledReceiver& r = receivers[pixel];
      irradiance[pixel] = static_cast<float>(unoccluded(view.light, frame.points.positions[pixel],
                                                        glm::dvec3(r.normal), glm::dvec3(r.geometric_normal))
                                                 .irradiance);
    }
  };
  culler_.for_each_family(groups_, frame.triangles(), view.light, config, nullptr,
                          [&](std::span<const soft::GroupDecision> family, int) {
                            std::for_each(family.begin(), family.end(), take_group);
                          });
  sampler.trace(casters, receivers, frame.points.width, frame.points.height, wanted_, irradiance);
  const auto traced = std::count(wanted_.begin(), wanted_.end(), 1);
  const auto seen = std::count_if(frame.points.triangles.begin(), frame.points.triangles.end(),
                                  [](std::uint32_t id) { return id != no_triangle; });
  traced_part_ = seen == 0 ? 0 : static_cast<double>(traced) / static_cast<double>(seen);
}

}  // namespace tenebra::bench
