// The stages of anti-aliasing: the ids, lights and colours of further samples of some pixels, by the same
// calls as for the pixels' centres, and the means.
#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "render/antialias/mask_means.h"
#include "render/antialias/pattern.h"
#include "render/antialias/pixel_choice.h"
#include "render/renderer_state.h"

namespace tenebra::render {
namespace {

constexpr std::size_t places_at_once = 16;                  // whose ids are kept
constexpr int squares_a_side = 2;                           // of pixels with a contrast
constexpr std::size_t most_samples = std::size_t{1} << 20;  // lit and shaded at once

/// The further samples of the chosen pixels, whether lit and shaded themselves or by others that stand for
/// them.
std::uint64_t sample_count(const ChosenPixels& chosen, std::size_t places) {
  return chosen.edges.size() * places + chosen.contrasts.size() * squares_a_side * squares_a_side;
}

}  // namespace

Expected<void> Renderer::State::find_sample_ids(const FrameInput& input, const RenderSettings& settings,
                                                std::span<const glm::vec2> offsets, const StopFlag* stop) {
  const FrameRaster::Wish wish{
      .width = settings.width, .height = settings.height, .simd = settings.hard.simd};
  return raster.draw_places(input.geometry, input.view, offsets, wish, further, stop);
}

namespace {

/// The light of samples, and their openness, in the order of a list whose `from` they are.
struct ListedLight {
  ListedLight(const SampleLights& lit, std::span<const std::uint32_t> from)
      : gathered(lit.lights, from),
        factors(gathered.factors()),
        openness(lit.openness.empty() ? 0 : from.size()) {
    for (std::size_t i = 0; i < openness.size(); ++i) openness[i] = lit.openness[from[i]];
  }
  GatheredFactors gathered;
  std::vector<shade::LightFactors> factors;
  std::vector<float> openness;
};

}  // namespace

Expected<void> Renderer::State::add_listed(const SampleLights& lit, float texture_px, std::size_t first) {
  const ListedLight light(lit, listed.from);
  return shading->add_samples({listed.ids, listed.places, light.factors, light.openness, texture_px},
                              shares_of_listed(first));
}

Expected<void> Renderer::State::add_behind_glass(const FrameInput& input,
                                                 const std::vector<DrawnLight>& lights,
                                                 const RenderSettings& settings, const SampleLights& lit,
                                                 std::size_t first, const StopFlag* stop) {
  const ListedLight light(lit, listed.from);
  const shade::Samples list{listed.ids, listed.places, light.factors, light.openness,
                            texture_width_px(settings.antialias)};
  if (auto done = shading->shade_samples(list, shaded); !done) return done;
  if (auto drawn = layer_packed(input, lights, settings, stop); !drawn) return drawn;
  return shading->add_colors(shares_of_listed(first), shaded);
}

Expected<void> Renderer::State::layer_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, const StopFlag* stop) {
  const TriangleView triangles = triangle_view(input.geometry);
  points::compute_sample_points(samples.layer, samples.places, samples.count, input.view, triangles,
                                layer_at_samples.points);
  compute_shading_normals(layer_at_samples.points, input.geometry.normals, input.view, triangles,
                          layer_at_samples.normals);
  if (auto lit = light_samples(input, lights, settings, LightKinds::all, layer_at_samples, stop); !lit)
    return lit;
  const SeeThroughSurfaces through = see_through_surfaces(scene, input.geometry, coordinates);
  const auto factors = at_samples.factors();
  const shade::PixelSamples behind_them{samples.grid.width(), samples.grid.height(), samples.ids, factors,
                                        at_samples.openness};
  if (!eye_tint.trace(at_samples.points, layer_at_samples, input.view, triangles, through, passes, stop))
    return base::stopped();
  const auto drawn =
      layer_colors({triangles, behind_them, samples.places, layer_at_samples, through, passes}, *shading);
  if (!drawn) return tl::unexpected(drawn.error());
  std::vector<std::uint32_t> entry(samples.grid.pixels());
  for (std::uint32_t i = 0; i < listed.from.size(); ++i) entry[listed.from[i]] = i;
  for (std::size_t i = 0; i < drawn->size(); ++i) shaded[entry[passes.pixels[i]]].color = (*drawn)[i];
  return {};
}

/// Edges: further samples with points and shadows of their own.
Expected<void> Renderer::State::add_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                          const RenderSettings& settings, const SampleFrame& frame,
                                          std::span<const std::uint32_t> chosen, std::size_t first,
                                          std::size_t place, MaskMeans& means, const StopFlag* stop) {
  const auto offsets = frame.offsets.subspan(place, further.places());
  pack_samples(chosen, seen.width, offsets, further, seen.ids, samples);
  if (auto lit = light_packed(input, lights, settings, frame, chosen, stop); !lit) return lit;
  const auto factors = at_samples.factors();
  const SampleLights lit{factors, at_samples.openness};
  if (!settings.antialias_everywhere) {
    list_groups(chosen, samples, lit, {seen.ids, seen.layer, {frame.pixels.factors, frame.pixels.openness}},
                SurfaceMatch(input.geometry, input.view), listed);
  } else {
    list_samples(chosen, samples, listed);
  }
  means.add(first, place, samples, at_samples);
  const bool behind_glass = std::any_of(samples.layer.begin(), samples.layer.end(),
                                        [](std::uint32_t id) { return id != no_triangle; });
  return behind_glass ? add_behind_glass(input, lights, settings, lit, first, stop)
                      : add_listed(lit, texture_width_px(settings.antialias), first);
}

/// Contrasts: a few places of each pixel, in the light of its centre.
Expected<void> Renderer::State::add_contrasts(const RenderSettings& settings, const SampleFrame& frame,
                                              std::span<const std::uint32_t> chosen, std::size_t first) {
  const std::vector<glm::vec2> places = square_places(squares_a_side);
  const StandIns stand_ins{frame.offsets, places,
                           sample_pattern(settings.antialias).centre_counts ? 1.0f : 0.0f};
  list_as_centres(chosen, seen.width, stand_ins, seen.ids, further, listed);
  return add_listed({frame.pixels.factors, frame.pixels.openness},
                    texture_width_px(squares_a_side * squares_a_side), first);
}

ChosenPixels Renderer::State::choose(const FrameInput& input, const RenderSettings& settings,
                                     const SampleFrame& frame, const FrameResult& result) const {
  CentrePicture centre{seen.width, seen.height, seen.ids, seen.layer, result.image, {}, {}};
  for (const LightMask& mask : result.masks) centre.masks.emplace_back(mask.mask.pixels);
  for (const shade::LightFactors& light : frame.pixels.factors)
    if (!light.tint.factors.empty()) centre.tints.push_back(light.tint);
  ChosenPixels chosen;
  chosen = choose_pixels(centre, frame.offsets.first(further.places()), further,
                         SurfaceMatch(input.geometry, input.view), settings.antialias_everywhere);
  return chosen;
}

Expected<void> Renderer::State::add_samples(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                            const RenderSettings& settings, const SampleFrame& frame,
                                            const ChosenPixels& chosen, std::size_t shared, std::size_t place,
                                            MaskMeans& means, const StopFlag* stop) {
  const std::size_t at_once = most_samples / further.places();
  const auto part = [&](std::span<const std::uint32_t> pixels, std::size_t i) {
    return pixels.subspan(i, std::min(at_once, pixels.size() - i));
  };
  const auto edges = std::span(chosen.edges);
  for (std::size_t i = 0; i < shared; i += at_once) {
    if (stop_requested(stop)) return base::stopped();
    if (auto added =
            add_edges(input, lights, settings, frame, part(edges.first(shared), i), i, place, means, stop);
        !added)
      return added;
  }
  if (auto added = add_shared(input, lights, settings, frame, edges.subspan(shared), shared, stop); !added)
    return added;
  for (std::size_t i = 0; i < chosen.contrasts.size(); i += at_once) {
    if (stop_requested(stop)) return base::stopped();
    if (auto added = add_contrasts(settings, frame, part(chosen.contrasts, i), chosen.edges.size() + i);
        !added)
      return added;
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
  std::size_t shared = 0;
  std::vector<std::uint32_t> pixels;
  MaskMeans means(settings, pattern, result);
  for (std::size_t place = 0; place < pattern.offsets.size(); place += places_at_once) {
    const auto offsets = frame.offsets.subspan(place, std::min(places_at_once, frame.offsets.size() - place));
    if (auto found = find_sample_ids(input, settings, offsets, stop); !found) return found;
    if (place == 0) {
      chosen = choose(input, settings, frame, result);
      shared = part_edges(input, lights, settings, frame, chosen);
      pixels = chosen.all();
      means.begin(chosen.edges);
      const MeansTask task{pixels, pattern.count(), pattern.centre_counts, settings.linear_mean};
      if (auto begun = shading->begin_means(task); !begun) return begun;
    }
    if (auto added = add_samples(input, lights, settings, frame, chosen, shared, place, means, stop); !added)
      return added;
  }
  means.finish();
  if (auto written = shading->finish_means(result.image, result.linear_mean); !written) return written;
  result.antialias = {chosen.count(), sample_count(chosen, pattern.offsets.size())};
  result.timings.antialias_ms = watch.lap_ms();
  return {};
}

}  // namespace tenebra::render
