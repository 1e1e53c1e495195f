// The stage of anti-aliasing that lights edges with hard shadows: samples get those of pixels' centres
// nearby, or their own.
#include <algorithm>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "render/antialias/pattern.h"
#include "render/renderer_state.h"

namespace tenebra::render {
namespace {

constexpr std::size_t most_edges_samples = std::size_t{1} << 21;  // at once; fewer are traced
constexpr std::size_t at_once = std::size_t{1} << 14;

}  // namespace

CentreShadows Renderer::State::centre_shadows(const SampleFrame& frame) const {
  CentreShadows out{seen.width, seen.height, seen.ids, {}, frame.pixels.factors, {}};
  if (seen.has_layer) out.layer = seen.layer;
  for (const shade::LightFactors& light : frame.pixels.factors)
    out.masks.push_back(light.mask.empty() ? nullptr : light.mask.data());
  return out;
}

/// Whether hard shadows of pixels' centres may stand for those of samples: not with more than four samples,
/// where the shadows that this misses would weigh more than what is left at edges, nor where masks of samples
/// are asked for.
bool Renderer::State::shares_masks(const std::vector<DrawnLight>& lights, const RenderSettings& settings) {
  return settings.antialias <= 4 && !settings.antialias_everywhere && !settings.mask_means &&
         !settings.sample_masks && settings.samples == SampleSource::ids && lights.size() <= most_lit_bits;
}

/// Puts those edges last that can do without samples in a picture of their own: no glass is near, and all
/// lights have hard shadows, or none. Returns how many are before them.
std::size_t Renderer::State::part_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                        const RenderSettings& settings, const SampleFrame& frame,
                                        ChosenPixels& chosen) const {
  if (has_areas(lights) || settings.ao.mode != AoMode::none || !shares_masks(lights, settings))
    return chosen.edges.size();
  if (input.geometry.see_through.empty()) return 0;
  const CentreShadows centres = centre_shadows(frame);
  const SurfaceMatch match(input.geometry, input.view);
  std::size_t with_glass = 0;
  with_glass = part_by_glass({chosen.edges, centres, frame.offsets, further, match}, chosen.edges);
  return with_glass;
}

Expected<void> Renderer::State::trace_own(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                          const RenderSettings& settings, const StopFlag* stop) {
  const std::size_t count = edges.own.size();
  if (count == 0) return {};
  if (stop_requested(stop)) return base::stopped();
  place_own(edges.own, own_ids, own_places);
  points::compute_sample_points(own_ids, own_places, count, input.view, triangle_view(input.geometry),
                                own_hard.points);
  if (auto lit = light_samples(input, lights, settings, LightKinds::masks, own_hard, stop); !lit) return lit;
  const points::SampleGrid grid(count);
  parallel::parallel_ranges(count, at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      LitBits bits = 0;
      for (std::size_t light = 0; light < lights.size(); ++light) {
        const ShadowMask& mask = own_hard.masks[light];
        if (!mask.empty() && mask[grid.pixel(i)] != 0) bits |= LitBits{1} << light;
      }
      edges.lit[edges.own[i].number] = bits;
    }
  });
  return {};
}

Expected<void> Renderer::State::light_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                            const RenderSettings& settings, const EdgeTask& task,
                                            const StopFlag* stop) {
  find_edge_samples(task, edges);
  return trace_own(input, lights, settings, stop);
}

Expected<void> Renderer::State::add_shared(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                           const RenderSettings& settings, const SampleFrame& frame,
                                           std::span<const std::uint32_t> chosen, std::size_t first,
                                           const StopFlag* stop) {
  const CentreShadows centres = centre_shadows(frame);
  const SurfaceMatch match(input.geometry, input.view);
  const std::size_t pixels_at_once = most_edges_samples / frame.offsets.size();
  for (std::size_t i = 0; i < chosen.size(); i += pixels_at_once) {
    const auto part = chosen.subspan(i, std::min(pixels_at_once, chosen.size() - i));
    const EdgeTask task{part, centres, frame.offsets, further, match};
    if (auto lit = light_edges(input, lights, settings, task, stop); !lit) return lit;
    list_edges(task, edges, listed);
    const GatheredFactors gathered = GatheredFactors::of_bits(frame.pixels.factors, listed.from);
    const auto factors = gathered.factors();
    const shade::Samples list{listed.ids, listed.places, factors, {}, texture_width_px(settings.antialias)};
    if (auto added = shading->add_samples(list, shares_of_listed(first + i)); !added) return added;
  }
  return {};
}

}  // namespace tenebra::render
