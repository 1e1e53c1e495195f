#include "render/antialias/edge_shadows.h"

#include "base/fail.h"
#include "parallel/parallel.h"
#include "points/sample_points.h"

namespace tenebra::render {
namespace {

constexpr std::size_t edges_at_once = std::size_t{1} << 14;

}  // namespace

bool shares_masks(const Frame& frame) {
  const RenderSettings& settings = frame.settings;
  return settings.antialias <= 4 && !settings.antialias_everywhere && !settings.mask_means &&
         !settings.sample_masks && settings.samples == SampleSource::ids &&
         frame.lights.size() <= most_lit_bits;
}

Expected<void> EdgeShadows::find(const SampleStages& stages, const EdgeTask& task) {
  find_edge_samples(task, edges_);
  return edges_.own.empty() ? Expected<void>() : trace_own(stages);
}

Expected<void> EdgeShadows::trace_own(const SampleStages& stages) {
  const Frame& frame = stages.frame;
  const std::size_t count = edges_.own.size();
  if (stop_requested(frame.stop)) return base::stopped();
  place_own(edges_.own, own_ids_, own_places_);
  points::compute_sample_points(own_ids_, own_places_, count, frame.input.view, frame.triangles(),
                                own_.points);
  if (auto lit = stages.lighter.light(frame, LightKinds::masks, own_); !lit) return lit;
  const points::SampleGrid grid(count);
  parallel::parallel_ranges(count, edges_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      LitBits bits = 0;
      for (std::size_t light = 0; light < frame.lights.size(); ++light) {
        const ShadowMask& mask = own_.lights[light].mask;
        if (!mask.empty() && mask[grid.pixel(i)] != 0) bits |= LitBits{1} << light;
      }
      edges_.lit[edges_.own[i].number] = bits;
    }
  });
  return {};
}

}  // namespace tenebra::render
