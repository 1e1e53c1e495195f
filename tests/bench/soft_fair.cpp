#include "soft_fair.h"

#include <algorithm>

namespace tenebra::bench {

void ShaftedSampler::trace(const SoftView& view, const EmbreeScene& casters,
                           std::span<const SampledReceiver> receivers, const SoftSampler& sampler,
                           std::span<float> irradiance) {
  const BenchFrame& frame = view.frame;
  const SoftShadowConfig config;
  group_points(frame.points, frame.view, frame.triangles(), view.light, config.grouping, groups_);
  wanted_.assign(receivers.size(), 0);
  std::fill(irradiance.begin(), irradiance.end(), 0.0f);
  culler_.for_each_group(groups_, frame.triangles(), view.light, config, nullptr,
                         [&](const PointGroup& group, std::span<const std::uint32_t>, GroupClass kind, int) {
                           for (const std::uint32_t pixel : groups_.pixels_of(group)) {
                             if (kind == GroupClass::mixed) wanted_[pixel] = 1;
                             if (kind != GroupClass::lit) continue;
                             const SampledReceiver& r = receivers[pixel];
                             irradiance[pixel] = static_cast<float>(
                                 unoccluded(view.light, frame.points.positions[pixel], glm::dvec3(r.normal),
                                            glm::dvec3(r.geometric_normal))
                                     .irradiance);
                           }
                         });
  sampler.trace(casters, receivers, frame.points.width, frame.points.height, wanted_, irradiance);
  const auto traced = std::count(wanted_.begin(), wanted_.end(), 1);
  const auto seen = std::count_if(frame.points.triangles.begin(), frame.points.triangles.end(),
                                  [](std::uint32_t id) { return id != no_triangle; });
  traced_part_ = seen == 0 ? 0 : static_cast<double>(traced) / static_cast<double>(seen);
}

}  // namespace tenebra::bench
