#include "render/antialias/anti_aliaser.h"

#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/sample_points.h"
#include "render/antialias/pattern.h"

namespace tenebra::render {
namespace {

constexpr std::size_t places_at_once = 16;                       // whose ids are kept
constexpr int squares_a_side = 2;                                // of pixels with a contrast
constexpr std::size_t most_samples = std::size_t{1} << 20;       // lit and shaded at once
constexpr std::size_t most_edge_samples = std::size_t{1} << 21;  // at once; fewer are traced

/// The further samples of the chosen pixels, whether lit and shaded themselves or by others that stand for
/// them.
std::uint64_t sample_count(const ChosenPixels& chosen, std::size_t places) {
  return chosen.edges.size() * places + chosen.contrasts.size() * squares_a_side * squares_a_side;
}

/// The light of samples, and their openness, in the order of a list.
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

SampleLights light_of(const Centres& centres) {
  return {centres.factors, centres.lit.openness};
}

/// Calls add(part, first) for parts of some pixels, which begin at chosen pixel `first`.
template <class Add>
Expected<void> for_each_part(const SampleStages& stages, std::span<const std::uint32_t> pixels,
                             std::size_t at_once, std::size_t first, Add add) {
  for (std::size_t i = 0; i < pixels.size(); i += at_once) {
    if (stop_requested(stages.frame.stop)) return base::stopped();
    if (auto added = add(pixels.subspan(i, std::min(at_once, pixels.size() - i)), first + i); !added)
      return added;
  }
  return {};
}

}  // namespace

Expected<void> AntiAliaser::add_listed(const SampleStages& stages, const SampleLights& lit, float texture_px,
                                       std::size_t first) {
  const ListedLight light(lit, listed_.from);
  return stages.shading.add_samples({listed_.ids, listed_.places, light.factors, light.openness, texture_px},
                                    shares_of_listed(first));
}

Expected<void> AntiAliaser::add_behind_layer(const SampleStages& stages, const SampleLights& lit,
                                             float texture_px, std::size_t first) {
  const ListedLight light(lit, listed_.from);
  const shade::Samples list{listed_.ids, listed_.places, light.factors, light.openness, texture_px};
  if (auto done = stages.shading.shade_samples(list, shaded_); !done) return done;
  const shade::PixelSamples behind{packed_.grid.width(), packed_.grid.height(), packed_.ids, lit.lights,
                                   lit.openness};
  const auto drawn =
      stages.layer.color(stages.frame, packed_.layer, packed_.count, {lit_.points, behind, packed_.places},
                         stages.lighter, stages.shading);
  if (!drawn) return tl::unexpected(drawn.error());
  std::vector<std::uint32_t> entry(packed_.grid.pixels());
  for (std::uint32_t i = 0; i < listed_.from.size(); ++i) entry[listed_.from[i]] = i;
  for (std::size_t i = 0; i < drawn->samples.size(); ++i)
    shaded_[entry[drawn->samples[i]]].color = drawn->colors[i];
  return stages.shading.add_colors(shares_of_listed(first), shaded_);
}

Expected<void> AntiAliaser::light_sparsely(const Round& round, std::span<const std::uint32_t> edges) {
  const Frame& frame = round.stages.frame;
  const SurfaceMatch match = round.stages.surface_match();
  const CentreShadows centres = round.stages.centre_shadows();
  if (auto found = edge_shadows_.find(round.stages, {edges, centres, round.offsets, seen_, match}); !found)
    return found;
  const std::vector<LitBits>& lit = edge_shadows_.samples().lit;
  for (std::size_t light = 0; light < frame.lights.size(); ++light) {
    if (frame.lights[light].area) continue;
    ShadowMask& to = lit_.lights[light].mask;
    to.resize(packed_.grid.pixels(), 0);
    parallel::parallel_ranges(packed_.count, std::size_t{1} << 14, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) to[packed_.slots[i]] = (lit[i] >> light & 1u) != 0 ? 255 : 0;
    });
  }
  return {};
}

Expected<void> AntiAliaser::light_packed(const Round& round, std::span<const std::uint32_t> edges) {
  const Frame& frame = round.stages.frame;
  const bool shadows = frame.has_shadows(), soft_too = frame.has_areas() || frame.has_occlusion();
  const bool sparsely = shadows && !frame.has_glass() && shares_masks(frame);
  if ((shadows && !sparsely) || soft_too || !packed_.layer.empty()) {
    points::compute_sample_points(packed_.ids, packed_.places, packed_.count, frame.input.view,
                                  frame.triangles(), lit_.points);
  }
  lit_.begin(frame.lights.size());
  Expected<void> lit;
  if (sparsely) {
    lit = light_sparsely(round, edges);
  } else if (shadows || soft_too) {
    lit = round.stages.lighter.light(frame, LightKinds::points, lit_);
  }
  return lit && soft_too ? borrowed_.add(round.stages, packed_, lit_) : lit;
}

Expected<void> AntiAliaser::add_edges(const Round& round, std::span<const std::uint32_t> edges,
                                      std::size_t first) {
  const SampleStages& stages = round.stages;
  const visibility::VisibleIds& seen = stages.centres.seen;
  pack_samples(edges, seen.width, round.offsets, seen_, seen.ids, packed_);
  if (auto lit = light_packed(round, edges); !lit) return lit;
  const auto factors = lit_.factors();
  const SampleLights lit{factors, lit_.openness};
  if (!stages.frame.settings.antialias_everywhere) {
    list_groups(edges, packed_, lit, {seen.ids, seen.layer, light_of(stages.centres)}, stages.surface_match(),
                listed_);
  } else {
    list_samples(edges, packed_, listed_);
  }
  round.masks.add(first, round.place, packed_, lit_);
  const float texture_px = texture_width_px(stages.frame.settings.antialias);
  const bool behind_layer = std::any_of(packed_.layer.begin(), packed_.layer.end(),
                                        [](std::uint32_t id) { return id != no_triangle; });
  return behind_layer ? add_behind_layer(stages, lit, texture_px, first)
                      : add_listed(stages, lit, texture_px, first);
}

Expected<void> AntiAliaser::add_shared(const Round& round, std::span<const std::uint32_t> edges,
                                       std::size_t first) {
  const SampleStages& stages = round.stages;
  const CentreShadows centres = stages.centre_shadows();
  const SurfaceMatch match = stages.surface_match();
  const EdgeTask task{edges, centres, round.offsets, seen_, match};
  if (auto found = edge_shadows_.find(stages, task); !found) return found;
  list_edges(task, edge_shadows_.samples(), listed_);
  const GatheredFactors gathered = GatheredFactors::of_bits(stages.centres.factors, listed_.from);
  const auto factors = gathered.factors();
  return stages.shading.add_samples(
      {listed_.ids, listed_.places, factors, {}, texture_width_px(stages.frame.settings.antialias)},
      shares_of_listed(first));
}

Expected<void> AntiAliaser::add_contrasts(const Round& round, std::span<const std::uint32_t> pixels,
                                          std::size_t first) {
  const SampleStages& stages = round.stages;
  const visibility::VisibleIds& seen = stages.centres.seen;
  const SamplePattern pattern = sample_pattern(stages.frame.settings.antialias);
  const std::vector<glm::vec2> places = square_places(squares_a_side);
  const StandIns stand_ins{pattern.offsets, places, pattern.centre_counts ? 1.0f : 0.0f};
  list_as_centres(pixels, seen.width, stand_ins, seen.ids, seen_, listed_);
  return add_listed(stages, light_of(stages.centres), texture_width_px(squares_a_side * squares_a_side),
                    first);
}

ChosenPixels AntiAliaser::choose(const Round& round, const io::Image8& picture) const {
  const Centres& centres = round.stages.centres;
  const visibility::VisibleIds& seen = centres.seen;
  CentrePicture centre{seen.width, seen.height, seen.ids, seen.layer, picture, {}, {}};
  for (const SampleLight& light : centres.lit.lights)
    if (!light.mask.empty()) centre.masks.emplace_back(light.mask);
  for (const shade::LightFactors& light : centres.factors)
    if (!light.tint.factors.empty()) centre.tints.push_back(light.tint);
  return choose_pixels(centre, round.offsets, seen_, round.stages.surface_match(),
                       round.stages.frame.settings.antialias_everywhere);
}

std::size_t AntiAliaser::part_edges(const Round& round, ChosenPixels& chosen) const {
  const Frame& frame = round.stages.frame;
  if (frame.has_areas() || frame.has_occlusion() || !shares_masks(frame)) return chosen.edges.size();
  if (!frame.has_glass()) return 0;
  const CentreShadows centres = round.stages.centre_shadows();
  const SurfaceMatch match = round.stages.surface_match();
  return part_by_glass({chosen.edges, centres, round.offsets, seen_, match}, chosen.edges);
}

Expected<void> AntiAliaser::add_samples(const Round& round, const ChosenPixels& chosen, std::size_t shared) {
  const std::size_t at_once = most_samples / seen_.places();
  const auto edges = std::span(chosen.edges);
  if (auto added = for_each_part(round.stages, edges.first(shared), at_once, 0,
                                 [&](auto part, std::size_t i) { return add_edges(round, part, i); });
      !added)
    return added;
  if (auto added =
          for_each_part(round.stages, edges.subspan(shared), most_edge_samples / seen_.places(), shared,
                        [&](auto part, std::size_t i) { return add_shared(round, part, i); });
      !added)
    return added;
  return for_each_part(round.stages, chosen.contrasts, at_once, edges.size(),
                       [&](auto part, std::size_t i) { return add_contrasts(round, part, i); });
}

Expected<void> AntiAliaser::run(const SampleStages& stages, FrameResult& result) {
  const Frame& frame = stages.frame;
  const RenderSettings& settings = frame.settings;
  if (settings.antialias == 1) return {};
  base::Stopwatch watch;
  const SamplePattern pattern = sample_pattern(settings.antialias);
  const FrameRaster::Wish wish{
      .width = settings.width, .height = settings.height, .simd = settings.hard.simd};
  ChosenPixels chosen;
  std::vector<std::uint32_t> pixels;  // all that are chosen
  std::size_t shared = 0;
  MaskMeans masks(settings, pattern, stages.centres.lit, result);
  for (std::size_t place = 0; place < pattern.offsets.size(); place += places_at_once) {
    const auto offsets =
        pattern.offsets.subspan(place, std::min(places_at_once, pattern.offsets.size() - place));
    if (auto found = stages.raster.draw_places(frame.input.geometry, frame.input.view, offsets, wish, seen_,
                                               frame.stop);
        !found)
      return found;
    const Round round{stages, offsets, place, masks};
    if (place == 0) {
      chosen = choose(round, result.image);
      shared = part_edges(round, chosen);
      pixels = chosen.all();
      masks.begin(chosen.edges);
      const MeansTask means{pixels, pattern.count(), pattern.centre_counts, settings.linear_mean};
      if (auto begun = stages.shading.begin_means(means); !begun) return begun;
    }
    if (auto added = add_samples(round, chosen, shared); !added) return added;
  }
  masks.finish();
  if (auto written = stages.shading.finish_means(result.image, result.linear_mean); !written) return written;
  result.antialias = {chosen.count(), sample_count(chosen, pattern.offsets.size())};
  result.timings.antialias_ms = watch.lap_ms();
  return {};
}

}  // namespace tenebra::render
