// The stages of anti-aliasing: what further samples of some pixels see, their lights and their colours, by
// the same calls as those of the pixels' centres, and the means.
#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "render/antialias/pattern.h"
#include "render/antialias/pixel_choice.h"
#include "render/antialias/sample_means.h"
#include "render/renderer_state.h"

namespace tenebra::render {
namespace {

constexpr std::size_t most_places = 16;                      // whose ids are kept at once
constexpr std::size_t most_samples = std::size_t{1} << 20;   // lit and shaded at once
constexpr std::uint32_t first_own = std::uint32_t{1} << 31;  // of what soft_from holds

bool has_areas(const std::vector<DrawnLight>& lights) {
  return std::any_of(lights.begin(), lights.end(),
                     [](const DrawnLight& light) { return light.area.has_value(); });
}

}  // namespace

Expected<void> Renderer::State::find_sample_ids(const FrameInput& input, const RenderSettings& settings,
                                                std::span<const glm::vec2> offsets, const StopFlag* stop) {
  const FrameRaster::Wish wish{.width = settings.width,
                               .height = settings.height,
                               .threads = settings.threads,
                               .simd = settings.hard.simd};
  further.resize(offsets.size());
  FrameTimings unused;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    if (stop_requested(stop)) return base::fail("stopped");
    if (auto drawn =
            raster.draw(input.geometry, shifted_view(input.view, offsets[k]), wish, seen_there, unused);
        !drawn)
      return drawn;
    further[k].ids.swap(seen_there.ids);
    further[k].layer.swap(seen_there.layer);
  }
  return {};
}

/// Soft shadows and occlusion vary slowly: a sample has those of the nearest pixel's centre, its own first,
/// that sees the same surface. Samples that no such centre is next to get their own, one for each surface of
/// a pixel.
void Renderer::State::borrow_soft(const FrameInput& input) {
  const SurfaceMatch match(input.geometry, input.view);
  const int width = seen.width, height = seen.height;
  soft_from.assign(samples.grid.pixels(), 0);
  parallel::parallel_ranges(samples.count, 4096, [&](std::size_t first, std::size_t last) {
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
          if (distance >= nearest || !match.same(id, seen.ids[next], samples.places[slot])) continue;
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
                                             const RenderSettings& settings, const FrameResult& result,
                                             const StopFlag* stop) {
  const TriangleView triangles = triangle_view(input.geometry);
  with_threads(settings.threads, [&] {
    borrow_soft(input);
    points::take_points(at_samples.points, own_slots, own_soft.points);
    compute_shading_normals(own_soft.points, input.geometry.normals, input.view, triangles, own_soft.normals);
  });
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
  with_threads(settings.threads, [&] {
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (!lights[i].area) continue;
      gather(irradiance[i], own_soft.irradiance[i], at_samples.irradiance[i]);
      gather(result.masks[i].visible_fraction.pixels, own_soft.visible_fraction[i],
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
  });
  return {};
}

Expected<void> Renderer::State::light_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, const FrameResult& result,
                                             const StopFlag* stop) {
  const bool shadows = settings.shadows != ShadowMode::none && !lights.empty();
  const bool soft_too = has_areas(lights) || settings.ao.mode != AoMode::none;
  if (shadows || soft_too || !samples.layer.empty()) {
    with_threads(settings.threads, [&] {
      points::compute_sample_points(samples.ids, samples.places, samples.count, input.view,
                                    triangle_view(input.geometry), at_samples.points);
    });
  }
  if (!shadows && !soft_too) {
    at_samples.masks.assign(lights.size(), {});
    at_samples.irradiance = at_samples.visible_fraction = {lights.size(), std::vector<float>()};
    at_samples.tints.assign(lights.size(), {});
    at_samples.openness.clear();
    return {};
  }
  at_samples.normals.clear();
  if (auto lit = light_samples(input, lights, settings, LightKinds::points, at_samples, stop); !lit)
    return lit;
  return soft_too ? light_softly(input, lights, settings, result, stop) : Expected<void>();
}

/// Colours of a list; with `from` numbers of what `lit` has.
void Renderer::State::shade_list(const RenderSettings& settings, const shade::Subject& subject,
                                 const shade::Lighting& lighting, const SampleLights& lit) {
  with_threads(settings.threads, [&] {
    const GatheredFactors gathered(lit.lights, listed.from);
    const auto factors = gathered.factors();
    std::vector<float> open(lit.openness.empty() ? 0 : listed.from.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = lit.openness[listed.from[i]];
    shade::shade_samples(subject, lighting,
                         {listed.ids, listed.places, factors, open, texture_width_px(settings.antialias)},
                         shaded);
  });
}

/// See-through surfaces before packed samples, over their colours.
Expected<void> Renderer::State::layer_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, const shade::Subject& subject,
                                             const shade::Lighting& lighting, const StopFlag* stop) {
  if (std::all_of(samples.layer.begin(), samples.layer.end(),
                  [](std::uint32_t id) { return id == no_triangle; }))
    return {};
  const TriangleView triangles = triangle_view(input.geometry);
  with_threads(settings.threads, [&] {
    points::compute_sample_points(samples.layer, samples.places, samples.count, input.view, triangles,
                                  layer_at_samples.points);
    compute_shading_normals(layer_at_samples.points, input.geometry.normals, input.view, triangles,
                            layer_at_samples.normals);
  });
  if (auto lit = light_samples(input, lights, settings, LightKinds::all, layer_at_samples, stop); !lit)
    return lit;
  const SeeThroughSurfaces through = see_through_surfaces(scene, input.geometry, coordinates);
  const auto factors = at_samples.factors();
  const shade::PixelSamples behind_them{samples.grid.width(), samples.grid.height(), samples.ids, factors,
                                        at_samples.openness};
  with_threads(settings.threads, [&] {
    eye_tint.trace(at_samples.points, layer_at_samples, input.view, triangles, through, passes);
    const auto drawn =
        layer_colors({subject, lighting, behind_them, samples.places, layer_at_samples, through, passes});
    std::vector<std::uint32_t> entry(samples.grid.pixels());
    for (std::uint32_t i = 0; i < listed.from.size(); ++i) entry[listed.from[i]] = i;
    for (std::size_t i = 0; i < drawn.size(); ++i) shaded[entry[passes.pixels[i]]].color = drawn[i];
  });
  return {};
}

/// Edges: further samples with points and shadows of their own.
Expected<void> Renderer::State::add_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                          const RenderSettings& settings, const SampleFrame& frame,
                                          std::span<const std::uint32_t> chosen, std::size_t first,
                                          std::size_t place, const FrameResult& result, SampleMeans& means,
                                          const StopFlag* stop) {
  const auto offsets = frame.offsets.subspan(place, further.size());
  with_threads(settings.threads,
               [&] { pack_samples(chosen, seen.width, offsets, further, seen.ids, samples); });
  if (auto lit = light_packed(input, lights, settings, result, stop); !lit) return lit;
  const auto factors = at_samples.factors();
  const SampleLights lit{factors, at_samples.openness};
  const bool merged = !settings.antialias_everywhere && input.geometry.see_through.empty();
  with_threads(settings.threads, [&] {
    if (merged) {
      list_groups(chosen, samples, lit, seen.ids, {frame.pixels.factors, frame.pixels.openness},
                  SurfaceMatch(input.geometry, input.view), listed);
    } else {
      list_samples(chosen, samples, listed);
    }
  });
  shade_list(settings, frame.subject, frame.lighting, lit);
  if (auto drawn = layer_packed(input, lights, settings, frame.subject, frame.lighting, stop); !drawn)
    return drawn;
  with_threads(settings.threads, [&] {
    means.add_colors(first, listed, shaded);
    means.add_masks(first, place, samples, at_samples);
  });
  return {};
}

/// What changes quickly in what is drawn: further samples in the light of their pixels' centres.
void Renderer::State::add_contrasts(const RenderSettings& settings, const SampleFrame& frame,
                                    std::span<const std::uint32_t> chosen, std::size_t first,
                                    std::size_t place, SampleMeans& means) {
  const auto offsets = frame.offsets.subspan(place, further.size());
  with_threads(settings.threads, [&] { list_as_centres(chosen, seen.width, offsets, further, listed); });
  shade_list(settings, frame.subject, frame.lighting, {frame.pixels.factors, frame.pixels.openness});
  with_threads(settings.threads, [&] { means.add_colors(first, listed, shaded); });
}

ChosenPixels Renderer::State::choose(const FrameInput& input, const RenderSettings& settings,
                                     const SampleFrame& frame, const FrameResult& result) const {
  CentrePicture centre{seen.width, seen.height, seen.ids, seen.layer, result.image, {}, {}};
  for (const LightMask& mask : result.masks) centre.masks.emplace_back(mask.mask.pixels);
  for (const shade::LightFactors& light : frame.pixels.factors)
    if (!light.tint.factors.empty()) centre.tints.push_back(light.tint.factors);
  ChosenPixels chosen;
  with_threads(settings.threads, [&] {
    chosen = choose_pixels(centre, frame.offsets.first(further.size()), further,
                           SurfaceMatch(input.geometry, input.view), settings.antialias_everywhere);
  });
  return chosen;
}

Expected<void> Renderer::State::add_samples(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                            const RenderSettings& settings, const SampleFrame& frame,
                                            const ChosenPixels& chosen, std::size_t place,
                                            const FrameResult& result, SampleMeans& means,
                                            const StopFlag* stop) {
  const std::size_t at_once = most_samples / further.size();
  const auto part = [&](const std::vector<std::uint32_t>& pixels, std::size_t i) {
    return std::span(pixels).subspan(i, std::min(at_once, pixels.size() - i));
  };
  for (std::size_t i = 0; i < chosen.edges.size(); i += at_once) {
    if (stop_requested(stop)) return base::fail("stopped");
    if (auto added =
            add_edges(input, lights, settings, frame, part(chosen.edges, i), i, place, result, means, stop);
        !added)
      return added;
  }
  for (std::size_t i = 0; i < chosen.contrasts.size(); i += at_once) {
    if (stop_requested(stop)) return base::fail("stopped");
    add_contrasts(settings, frame, part(chosen.contrasts, i), chosen.edges.size() + i, place, means);
  }
  return {};
}

Expected<void> Renderer::State::antialias(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                          const RenderSettings& settings, const SampleFrame& frame,
                                          FrameResult& result, const StopFlag* stop) {
  if (settings.antialias == 1) return {};
  base::Stopwatch watch;
  const SamplePattern pattern = sample_pattern(settings.antialias);
  ChosenPixels chosen;
  SampleMeans means(settings, pattern, display_of(settings), colors, result);
  for (std::size_t place = 0; place < pattern.offsets.size(); place += most_places) {
    const auto offsets = frame.offsets.subspan(place, std::min(most_places, frame.offsets.size() - place));
    if (auto found = find_sample_ids(input, settings, offsets, stop); !found) return found;
    if (place == 0) {
      chosen = choose(input, settings, frame, result);
      with_threads(settings.threads, [&] { means.begin(chosen.edges, chosen.contrasts); });
    }
    if (auto added = add_samples(input, lights, settings, frame, chosen, place, result, means, stop); !added)
      return added;
  }
  with_threads(settings.threads, [&] { means.finish(); });
  const std::size_t pixels = chosen.edges.size() + chosen.contrasts.size();
  result.antialias = {pixels, pixels * pattern.offsets.size()};
  result.timings.antialias_ms = watch.lap_ms();
  return {};
}

}  // namespace tenebra::render
