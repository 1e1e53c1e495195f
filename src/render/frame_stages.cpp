// The stages of a frame: ids, points, ambient occlusion, lights, colours.
#include <algorithm>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/point_tiles.h"
#include "render/antialias/pattern.h"
#include "render/light_casters.h"
#include "render/mask_colour.h"
#include "render/renderer_state.h"
#include "render/shadow_lights.h"

namespace tenebra::render {

void Renderer::State::points_from_depth(const ViewRays& view) {
  const std::size_t width = static_cast<std::size_t>(seen.width),
                    height = static_cast<std::size_t>(seen.height);
  points.width = seen.width;
  points.height = seen.height;
  points.triangles = seen.ids;
  points.tiles.clear();
  points.positions.resize(width * height);
  parallel::parallel_ranges(height, 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first * width; i < last * width; ++i) {
      if (seen.depth[i] <= 0) points.triangles[i] = no_triangle;
      if (points.triangles[i] == no_triangle) continue;
      points.positions[i] = visibility::point_from_depth(view, seen.transform, static_cast<int>(i % width),
                                                         static_cast<int>(i / width), seen.depth[i]);
    }
  });
}

Expected<void> Renderer::State::find_ids(const FrameInput& input, const RenderSettings& settings,
                                         FrameTimings& timings) {
  if (!input.ids.empty()) {
    seen = {.width = settings.width, .height = settings.height, .transform = {}, .ids = input.ids};
    const std::size_t triangles = input.geometry.triangles.size();
    for (std::uint32_t& id : seen.ids)
      if (id >= triangles) id = no_triangle;
    return {};
  }
  const FrameRaster::Wish wish{.width = settings.width,
                               .height = settings.height,
                               .with_depth = settings.samples == SampleSource::depth,
                               .simd = settings.hard.simd};
  return raster.draw(input.geometry, input.view, wish, seen, timings);
}

void Renderer::State::find_points(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                  const RenderSettings& settings, FrameTimings& timings) {
  base::Stopwatch watch;
  const bool exact = settings.samples == SampleSource::ids;
  const bool areas = has_areas(lights);
  const bool others =
      settings.shadows != ShadowMode::none &&
      std::any_of(lights.begin(), lights.end(), [](const auto& light) { return !light.area; });
  const bool traced = others || (areas && settings.soft_points > 0);
  const bool tiled = traced && settings.hard.variant == Variant::tiles;
  const bool shaded = areas || settings.ao.mode != AoMode::none;
  const bool positions = shaded || !tiled || !input.geometry.see_through.empty();
  const TriangleView triangles = triangle_view(input.geometry);
  const PointLayout layout = !tiled      ? PointLayout::rows
                             : positions ? PointLayout::rows_and_tiles
                                         : PointLayout::tiles;
  if (!exact) {
    points_from_depth(input.view);
  } else if (lifts_points(settings)) {
    find_lifted_points(input, layout, shaded);
  } else {
    compute_visible_points(seen.ids, seen.width, seen.height, input.view, triangles, points, layout);
    if (shaded) compute_shading_normals(points, input.geometry.normals, input.view, triangles, normals);
  }
  timings.points_ms = watch.lap_ms();
}

void Renderer::State::find_lifted_points(const FrameInput& input, PointLayout layout, bool shaded) {
  TriangleView triangles = triangle_view(input.geometry), smooth = triangles;
  smooth.normals = input.geometry.normals;
  if (!shaded)
    return compute_visible_points(seen.ids, seen.width, seen.height, input.view, smooth, points, layout);
  compute_visible_points(seen.ids, seen.width, seen.height, input.view, triangles, points);
  compute_shading_normals(points, input.geometry.normals, input.view, triangles, normals);
  lift_visible_points(input.view, smooth, points);
  if (layout != PointLayout::rows) points::make_point_tiles(points, input.view, smooth, *points.tiles);
}

TriangleView Renderer::State::traced_triangles(const FrameInput& input, const DrawnLight& light,
                                               const RenderSettings& settings) {
  TriangleView triangles = casters_of(scene, input.geometry, light, casters);
  if (lifts_points(settings)) triangles.normals = input.geometry.normals;
  // The same number for further samples, and for all lights with the same casters: tracers then use what they
  // have made of these triangles.
  if (triangles.casts_shadow.data() == input.geometry.casts_shadow.data()) triangles.version = frames_begun;
  return triangles;
}

Expected<void> Renderer::State::occlude_ambient(const FrameInput& input, const RenderSettings& settings,
                                                FrameResult& result, const AoProgress& progress,
                                                const StopFlag* stop) {
  Expected<void> done;
  done = ambient.compute(scene, input.geometry, points, normals, settings.ao, openness, progress, stop);
  if (!done) return done;
  result.ao = ambient.stats();
  result.timings.ao_build_ms = ambient.timings().ao_build_ms;
  result.timings.ao_ms = ambient.timings().ao_ms;
  result.notes.insert(result.notes.end(), ambient.notes().begin(), ambient.notes().end());
  return {};
}

Expected<void> Renderer::State::trace_hard(const FrameInput& input, const DrawnLight& light,
                                           const RenderSettings& settings, FrameResult& result,
                                           const StopFlag* stop) {
  HardShadowConfig config = settings.hard;
  if (settings.samples == SampleSource::depth) config.contact = ContactRule::none;
  config.count_pixel_nodes = settings.diagnostics;
  const TriangleView triangles = traced_triangles(input, light, settings);
  bool done = false;
  done = hard.trace_shadow_mask(points, input.view, triangles, shadow_light(light.light, light.placed),
                                config, hard_mask, stop);
  if (!done) return base::stopped();
  result.methods.push_back({light.number, hard.ran()});
  result.stats += hard.stats();
  add_shadow_stages(result.timings, hard.timings());
  base::Stopwatch watch;
  LightMask& out = result.masks.emplace_back();
  out.light = light.number;
  out.mask = {seen.width, seen.height, 1, hard_mask};
  out.nodes.assign(hard.pixel_nodes().begin(), hard.pixel_nodes().end());
  if (settings.shadows == ShadowMode::soft) {
    out.visible_fraction = {seen.width, seen.height, 1, {}};
    for (const std::uint8_t lit : hard_mask) out.visible_fraction.pixels.push_back(lit != 0 ? 1.0f : 0.0f);
    if (settings.error_maps)
      out.error = {seen.width, seen.height, 1, std::vector<float>(hard_mask.size(), 0.0f)};
  }
  result.timings.writeback_ms += watch.lap_ms();
  return {};
}

Expected<void> Renderer::State::trace_soft(const FrameInput& input, const DrawnLight& light,
                                           const RenderSettings& settings, FrameResult& result,
                                           std::vector<float>& irradiance_out, const StopFlag* stop) {
  if (auto done = trace_area({input, settings, points, normals, &result, stop}, light, lit_side); !done)
    return done;
  base::Stopwatch watch;
  LightMask& out = result.masks.emplace_back();
  out.light = light.number;
  out.visible_fraction = {seen.width, seen.height, 1, lit_side.lit.visible_fraction};
  out.mask = in_levels(out.visible_fraction);
  out.classes = lit_side.classes;
  if (settings.error_maps) {
    out.error = {seen.width, seen.height, 1, lit_side.errors};
    out.error.pixels.resize(lit_side.lit.visible_fraction.size());  // all exact
  }
  out.tint = lit_side.tint;
  std::swap(irradiance_out, lit_side.lit.irradiance);
  result.timings.writeback_ms += watch.lap_ms();
  return {};
}

Expected<void> Renderer::State::trace_lights(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, FrameResult& result,
                                             const StopFlag* stop) {
  if (irradiance.size() < lights.size()) irradiance.resize(lights.size());
  tint_has_surfaces = false;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (stop_requested(stop)) return base::stopped();
    if (lights[i].area) {
      if (auto done = trace_soft(input, lights[i], settings, result, irradiance[i], stop); !done) return done;
    } else if (settings.shadows != ShadowMode::none) {
      if (auto done = trace_hard(input, lights[i], settings, result, stop); !done) return done;
      if (input.geometry.see_through.empty()) continue;
      LightMask& hard_lit = result.masks.back();
      base::Stopwatch watch;
      if (auto done = trace_tint(input, lights[i], settings, points, {}, hard_mask, {}, hard_lit.tint, stop);
          !done)
        return done;
      result.timings.tint_ms += watch.lap_ms();
    }
  }
  return {};
}

/// The colours behind the picture.
Expected<void> Renderer::State::keep_linear(const RenderSettings& settings, FrameResult& result) const {
  result.linear = {};
  result.linear_mean = {};
  result.seen.clear();
  if (settings.linear_mean) {
    if (auto copied = shading->copy_linear(result.linear_mean); !copied) return copied;
  }
  if (!settings.linear) return {};
  for (const std::uint32_t id : seen.ids) result.seen.push_back(id != no_triangle ? 1 : 0);
  return shading->copy_linear(result.linear);
}

Expected<void> Renderer::State::begin_shading(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                              const RenderSettings& settings) {
  const shade::Lighting lighting{lights, scene.ambient_light, scene.background,
                                 environment ? &*environment : nullptr};
  return shading->begin({{input.geometry, input.view, surfaces, lifts_points(settings)},
                         lighting,
                         display_of(settings),
                         seen.width,
                         seen.height,
                         seen.ids,
                         needs_colors(settings)});
}

Expected<void> Renderer::State::shade_pixels(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                             const RenderSettings& settings, FrameResult& result,
                                             const StopFlag* stop) {
  std::vector<shade::LightFactors> factors(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const DrawnLight& light = lights[i];
    if (light.area) {
      factors[i].irradiance = irradiance[i];
    } else if (settings.shadows != ShadowMode::none) {
      factors[i].mask = result.masks[i].mask.pixels;  // every light has one
    }
    if (input.geometry.see_through.empty() || settings.shadows == ShadowMode::none) continue;
    if (tints.size() < lights.size()) tints.resize(lights.size());
    tints[i].begin(seen.ids.size());
    tints[i].set(result.masks[i].tint);
    factors[i].tint = tints[i].factors();
  }
  shade::PixelSamples pixels{seen.width, seen.height, seen.ids, factors, {}};
  if (settings.ao.mode != AoMode::none) pixels.openness = openness;
  if (auto done = shading->shade_centres(pixels, result.image); !done) return done;
  fill_aovs(input, lights, settings, factors, result);
  if (auto drawn = draw_see_through(input, lights, pixels, settings, result, stop); !drawn) return drawn;
  if (auto kept = keep_linear(settings, result); !kept) return kept;
  const SamplePattern pattern = sample_pattern(settings.antialias);
  return antialias(input, lights, settings, {pixels, result.masks, pattern.offsets}, result, stop);
}

void Renderer::State::keep_new(std::vector<std::string>& notes) {
  std::erase_if(notes, [&](const std::string& note) { return !said.insert(note).second; });
}

}  // namespace tenebra::render
