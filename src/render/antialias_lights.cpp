// The stage of anti-aliasing that finds the light at further samples: their own, or that of nearby pixels'
// centres that see the same surface.
#include <algorithm>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "render/renderer_state.h"

namespace tenebra::render {
namespace {

constexpr std::uint32_t first_own = std::uint32_t{1} << 31;  // values of soft_from below it are pixels

}  // namespace

/// Soft shadows and occlusion vary slowly: a sample has those of the nearest pixel's centre, its own first,
/// that sees the same surface. Samples that no such centre is next to get their own, one for each surface of
/// a pixel.
void Renderer::State::borrow_soft(const FrameInput& input) {
  SurfaceMatch match(input.geometry, input.view);
  const int width = seen.width, height = seen.height;
  soft_from.assign(samples.grid.pixels(), 0);
  parallel::parallel_ranges(samples.count, 4096, [&](std::size_t first, std::size_t last) {
    SurfaceMatch own_match(match);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t slot = samples.slots[i];
      const std::uint32_t pixel = samples.pixels[slot], id = samples.ids[slot];
      const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
      soft_from[slot] = first_own;
      float nearest = 1e9f;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) continue;
          const auto next = static_cast<std::uint32_t>((y + dy) * width + x + dx);
          const glm::vec2 apart =
              glm::vec2(static_cast<float>(x + dx) + 0.5f, static_cast<float>(y + dy) + 0.5f) -
              samples.places[slot];
          const float distance = next == pixel ? 0.0f : glm::dot(apart, apart);
          if (distance >= nearest || !own_match.same(id, seen.ids[next], samples.places[slot])) continue;
          nearest = distance;
          soft_from[slot] = next;
        }
      }
    }
  });
  own_slots.clear();
  for (std::size_t i = 0; i < samples.count; ++i) {
    const std::size_t slot = samples.slots[i];
    if (soft_from[slot] != first_own) continue;
    const std::size_t of_pixel = i / samples.per_pixel * samples.per_pixel;
    for (std::size_t k = of_pixel; k < i && soft_from[slot] == first_own; ++k) {
      const std::size_t other = samples.slots[k];
      if (soft_from[other] > first_own &&
          match.same(samples.ids[slot], samples.ids[other], samples.places[slot]))
        soft_from[slot] = soft_from[other];
    }
    if (soft_from[slot] != first_own) continue;
    own_slots.push_back(static_cast<std::uint32_t>(slot));
    soft_from[slot] = first_own + static_cast<std::uint32_t>(own_slots.size());
  }
}

Expected<void> Renderer::State::light_softly(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, const SampleFrame& frame,
                                             const StopFlag* stop) {
  const TriangleView triangles = triangle_view(input.geometry);
  borrow_soft(input);
  points::take_points(at_samples.points, own_slots, own_soft.points);
  compute_shading_normals(own_soft.points, input.geometry.normals, input.view, triangles, own_soft.normals);
  if (auto lit = light_samples(input, lights, settings, LightKinds::areas, own_soft, stop); !lit) return lit;
  const points::SampleGrid grid(own_slots.size());
  const auto value = [&](const auto& of_pixels, const auto& own, std::uint32_t from) {
    return from < first_own ? of_pixels[from] : own[grid.pixel(from - first_own - 1)];
  };
  const auto gather = [&](const auto& of_pixels, const auto& own, auto& out) {
    out.resize(soft_from.size());
    for (std::size_t i = 0; i < soft_from.size(); ++i)
      out[i] = samples.ids[i] == no_triangle ? 0.0f : value(of_pixels, own, soft_from[i]);
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].area) continue;
    gather(irradiance[i], own_soft.irradiance[i], at_samples.irradiance[i]);
    gather(frame.masks[i].visible_fraction.pixels, own_soft.visible_fraction[i],
           at_samples.visible_fraction[i]);
    if (input.geometry.see_through.empty()) continue;
    TintMask tint;
    for (std::uint32_t slot = 0; slot < soft_from.size(); ++slot) {
      if (samples.ids[slot] == no_triangle) continue;
      const glm::vec3 factor =
          value(tints[i].factors().factors, own_soft.tints[i].factors().factors, soft_from[slot]);
      if (factor == glm::vec3(1.0f)) continue;
      tint.pixels.push_back(slot);
      tint.factors.push_back(factor);
    }
    at_samples.tints[i].set(tint);
  }
  if (settings.ao.mode != AoMode::none) gather(openness, own_soft.openness, at_samples.openness);
  return {};
}

/// The hard shadows of samples: of others nearby where these agree, else their own.
Expected<void> Renderer::State::light_sparsely(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                               const RenderSettings& settings, const EdgeTask& task,
                                               const StopFlag* stop) {
  if (auto lit = light_edges(input, lights, settings, task, stop); !lit) return lit;
  for (std::size_t light = 0; light < lights.size(); ++light) {
    ShadowMask& to = at_samples.masks[light];
    if (lights[light].area) continue;
    to.resize(samples.grid.pixels(), 0);
    parallel::parallel_ranges(samples.count, std::size_t{1} << 14, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        to[samples.slots[i]] = (edges.lit[i] >> light & 1u) != 0 ? 255 : 0;
    });
  }
  return {};
}

Expected<void> Renderer::State::light_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, const SampleFrame& frame,
                                             std::span<const std::uint32_t> chosen, const StopFlag* stop) {
  const bool shadows = settings.shadows != ShadowMode::none && !lights.empty();
  const bool soft_too = has_areas(lights) || settings.ao.mode != AoMode::none;
  const bool sparsely = shadows && input.geometry.see_through.empty() && shares_masks(lights, settings);
  if ((shadows && !sparsely) || soft_too || !samples.layer.empty()) {
    points::compute_sample_points(samples.ids, samples.places, samples.count, input.view,
                                  triangle_view(input.geometry), at_samples.points);
  }
  at_samples.normals.clear();
  at_samples.begin(lights.size());
  Expected<void> lit;
  if (sparsely) {
    const SurfaceMatch match(input.geometry, input.view);
    const CentreShadows centres = centre_shadows(frame);
    lit = light_sparsely(input, lights, settings, {chosen, centres, frame.offsets, further, match}, stop);
  } else if (shadows || soft_too) {
    lit = light_samples(input, lights, settings, LightKinds::points, at_samples, stop);
  }
  if (!lit || !soft_too) return lit;
  return light_softly(input, lights, settings, frame, stop);
}

}  // namespace tenebra::render
