// The stages of a frame that only scenes with see-through surfaces have: tints of lights, and the layer.
#include <algorithm>
#include <utility>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
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
  const TriangleView triangles = casters_of(scene, input.geometry, light, casters);
  TintConfig config;
  config.simd = settings.hard.simd;
  config.own_irradiance = settings.soft_points > 0;
  config.same_surfaces = std::exchange(tint_has_surfaces, true);
  if (settings.samples == SampleSource::depth) config.contact = ContactRule::none;
  bool done = true;
  with_threads(settings.threads, [&] {
    if (!light.area) {
      const ShadowLight source = shadow_light(light.light, light.placed);
      return tint.trace(at, input.view, triangles, surfaces, source, mask, config, out);
    }
    done = tint.trace(at, shading_normals, input.view, triangles, surfaces, *light.area, soft_lit, config,
                      out, stop);
  });
  return done ? Expected<void>() : Expected<void>(base::fail("stopped"));
}

/// The layer's samples, and what is left of each light at them.
Expected<void> Renderer::State::light_layer(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                            const RenderSettings& settings, const StopFlag* stop) {
  const TriangleView triangles = triangle_view(input.geometry);
  with_threads(settings.threads, [&] {
    compute_visible_points(layer.ids, seen.width, seen.height, input.view, triangles, layer.points,
                           PointLayout::rows_and_tiles);
    compute_shading_normals(layer.points, input.geometry.normals, input.view, triangles, layer.normals);
  });
  layer.masks.assign(lights.size(), {});
  layer.irradiance.assign(lights.size(), {});
  layer.tints.resize(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (stop_requested(stop)) return base::fail("stopped");
    layer.tints[i].begin(layer.ids.size());
    if (settings.shadows == ShadowMode::none) continue;
    if (lights[i].area) {
      const AreaTask task{input, settings, layer.points, layer.normals, nullptr, stop};
      if (auto done = trace_area(task, lights[i], lit_side); !done) return done;
      layer.tints[i].set(lit_side.tint);
      layer.irradiance[i] = lit_side.lit.irradiance;
      continue;
    }
    bool done = false;
    with_threads(settings.threads, [&] {
      HardShadowConfig config = settings.hard;
      config.contact = ContactRule::triangle_ids;
      done = hard.trace_shadow_mask(
          layer.points, input.view, casters_of(scene, input.geometry, lights[i], casters),
          shadow_light(lights[i].light, lights[i].placed), config, layer.masks[i], stop);
    });
    if (!done) return base::fail("stopped");
    TintMask found;
    RenderSettings exact = settings;
    exact.samples = SampleSource::ids;
    if (auto traced =
            trace_tint(input, lights[i], exact, layer.points, layer.normals, layer.masks[i], {}, found, stop);
        !traced)
      return traced;
    layer.tints[i].set(found);
  }
  layer.openness.clear();
  if (settings.ao.mode == AoMode::none) return {};
  Expected<void> done;
  with_threads(settings.threads, [&] {
    done = ambient.compute(scene, input.geometry, layer.points, layer.normals, settings.ao, layer.openness,
                           {}, stop);
  });
  return done;
}

Expected<void> Renderer::State::draw_see_through(
    const FrameInput& input, const std::vector<DrawnLight>& lights, const shade::Subject& subject,
    const shade::Lighting& lighting, const shade::PixelSamples& opaque, const RenderSettings& settings,
    FrameResult& result, const StopFlag* stop) {
  if (!seen.has_layer) return {};
  base::Stopwatch watch;
  layer.ids.swap(seen.layer);
  if (std::all_of(layer.ids.begin(), layer.ids.end(), [](std::uint32_t id) { return id == no_triangle; }))
    return {};
  if (auto lit = light_layer(input, lights, settings, stop); !lit) return lit;
  const TriangleView triangles = triangle_view(input.geometry);
  const SeeThroughSurfaces surfaces = see_through_surfaces(scene, input.geometry, coordinates);
  with_threads(settings.threads, [&] {
    // The points that shadows start from may be those of the depth buffer, or none.
    const bool found =
        settings.ao.mode != AoMode::none || (settings.shadows != ShadowMode::none && !lights.empty());
    const bool there = found && settings.samples == SampleSource::ids;
    if (!there) {
      compute_visible_points(seen.ids, seen.width, seen.height, input.view, triangles, behind,
                             PointLayout::rows_and_tiles);
    }
    eye_tint.trace(there ? points : behind, layer, input.view, triangles, surfaces, passes);
    draw_layer({subject, lighting, opaque, layer, surfaces, passes, display_of(settings)}, result.image,
               result.linear);
  });
  result.timings.layer_ms = watch.lap_ms();
  return {};
}

}  // namespace tenebra::render
