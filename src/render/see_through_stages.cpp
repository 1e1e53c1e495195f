// The stages of a frame that only scenes with see-through surfaces have: tints of lights, and the layer.
#include <algorithm>
#include <utility>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/point_tiles.h"
#include "render/light_casters.h"
#include "render/renderer_state.h"
#include "render/shadow_lights.h"

namespace tenebra::render {

const FrameInput& Renderer::State::cast_as(SeeThrough see_through, const FrameInput& input) {
  if (see_through == SeeThrough::tint || input.geometry.see_through.empty()) return input;
  recast = input;
  cast_see_through(see_through, recast.geometry);
  return recast;
}

Expected<void> Renderer::State::trace_tint(const FrameInput& input, const DrawnLight& light,
                                           const RenderSettings& settings, const VisiblePoints& at,
                                           std::span<const glm::vec3> shading_normals, const ShadowMask& mask,
                                           const SoftMask& soft_lit, TintMask& out, const StopFlag* stop) {
  const SeeThroughSurfaces surfaces = see_through_surfaces(scene, input.geometry, coordinates);
  const TriangleView triangles = traced_triangles(input, light, settings);
  TintConfig config;
  config.simd = settings.hard.simd;
  config.own_irradiance = settings.soft_points > 0 || settings.soft.error_255 > 0;
  config.error_255 = settings.soft.error_255;
  config.same_surfaces = std::exchange(tint_has_surfaces, true);
  if (settings.samples == SampleSource::depth) config.contact = ContactRule::none;
  bool done = true;
  done = light.area ? tint.trace(at, shading_normals, input.view, triangles, surfaces, *light.area, soft_lit,
                                 config, out, stop)
                    : tint.trace(at, input.view, triangles, surfaces, shadow_light(light.light, light.placed),
                                 mask, config, out, stop);
  return done ? Expected<void>() : Expected<void>(base::stopped());
}

const VisiblePoints& Renderer::State::lit_points(const FrameInput& input, const RenderSettings& settings,
                                                 LitSamples& samples) {
  const VisiblePoints& from = samples.points;
  if (!lifts_points(settings)) return from;
  TriangleView smooth = triangle_view(input.geometry);
  smooth.normals = input.geometry.normals;
  VisiblePoints& to = samples.lifted;
  to.width = from.width, to.height = from.height, to.view = from.view;
  to.triangles = from.triangles;
  to.positions.resize(from.positions.size());
  to.tiles.clear();
  parallel::parallel_ranges(to.triangles.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      if (to.triangles[i] != no_triangle) to.positions[i] = from.positions[i];
  });
  lift_visible_points(input.view, smooth, to);
  points::make_point_tiles(to, input.view, smooth, *to.tiles);
  return to;
}

Expected<void> Renderer::State::light_samples(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                              const RenderSettings& settings, LightKinds kinds,
                                              LitSamples& samples, const StopFlag* stop) {
  const bool shadows = settings.shadows != ShadowMode::none;
  const bool coloured = shadows && kinds != LightKinds::masks && !input.geometry.see_through.empty();
  samples.begin(lights.size(), coloured ? samples.points.triangles.size() : 0);
  const bool without_areas = kinds == LightKinds::points || kinds == LightKinds::masks;
  const VisiblePoints& lit_at = lit_points(input, settings, samples);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (stop_requested(stop)) return base::stopped();
    if (!shadows) continue;
    if (lights[i].area ? without_areas : kinds == LightKinds::areas) continue;
    if (lights[i].area) {
      const AreaTask task{input, settings, lit_at, samples.normals, nullptr, stop};
      if (auto done = trace_area(task, lights[i], lit_side); !done) return done;
      if (coloured) samples.tints[i].set(lit_side.tint);
      samples.irradiance[i] = lit_side.lit.irradiance;
      samples.visible_fraction[i] = lit_side.lit.visible_fraction;
      continue;
    }
    bool done = false;
    HardShadowConfig config = settings.hard;
    config.contact = ContactRule::triangle_ids;
    done = hard.trace_shadow_mask(lit_at, input.view, traced_triangles(input, lights[i], settings),
                                  shadow_light(lights[i].light, lights[i].placed), config, samples.masks[i],
                                  stop);
    if (!done) return base::stopped();
    if (!coloured) continue;
    TintMask found;
    RenderSettings exact = settings;
    exact.samples = SampleSource::ids;
    if (auto traced =
            trace_tint(input, lights[i], exact, lit_at, samples.normals, samples.masks[i], {}, found, stop);
        !traced)
      return traced;
    samples.tints[i].set(found);
  }
  if (settings.ao.mode == AoMode::none || without_areas) return {};
  Expected<void> done;
  done = ambient.compute(scene, input.geometry, lit_at, samples.normals, settings.ao, samples.openness, {},
                         stop);
  return done;
}

Expected<void> Renderer::State::draw_see_through(const FrameInput& input,
                                                 const std::vector<DrawnLight>& lights,
                                                 const shade::PixelSamples& opaque,
                                                 const RenderSettings& settings, FrameResult& result,
                                                 const StopFlag* stop) {
  if (!seen.has_layer) return {};
  base::Stopwatch watch;
  if (std::all_of(seen.layer.begin(), seen.layer.end(), [](std::uint32_t id) { return id == no_triangle; }))
    return {};
  const TriangleView triangles = triangle_view(input.geometry);
  compute_visible_points(seen.layer, seen.width, seen.height, input.view, triangles, layer.points,
                         PointLayout::rows_and_tiles);
  compute_shading_normals(layer.points, input.geometry.normals, input.view, triangles, layer.normals);
  if (auto lit = light_samples(input, lights, settings, LightKinds::all, layer, stop); !lit) return lit;
  const SeeThroughSurfaces surfaces = see_through_surfaces(scene, input.geometry, coordinates);
  // The points that shadows start from may be those of the depth buffer, lifted ones, or none.
  const bool found =
      settings.ao.mode != AoMode::none || (settings.shadows != ShadowMode::none && !lights.empty());
  const bool there = found && settings.samples == SampleSource::ids && !lifts_points(settings);
  if (!there) {
    ids_behind.resize(seen.ids.size());
    parallel::parallel_ranges(ids_behind.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        ids_behind[i] = seen.layer[i] == no_triangle ? no_triangle : seen.ids[i];
    });
    compute_visible_points(ids_behind, seen.width, seen.height, input.view, triangles, behind,
                           PointLayout::rows_and_tiles);
  }
  if (!eye_tint.trace(there ? points : behind, layer, input.view, triangles, surfaces, passes, stop))
    return base::stopped();
  const auto drawn = layer_colors({triangles, opaque, {}, layer, surfaces, passes}, *shading);
  if (!drawn) return tl::unexpected(drawn.error());
  if (auto done = shading->replace_centres(passes.pixels, *drawn, result.image); !done) return done;
  result.timings.layer_ms = watch.lap_ms();
  return {};
}

}  // namespace tenebra::render
