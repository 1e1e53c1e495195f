#include "render/lighter.h"

#include <utility>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/point_tiles.h"
#include "render/light_casters.h"
#include "render/mask_colour.h"
#include "render/shadow_lights.h"

namespace tenebra::render {
namespace {

constexpr std::size_t lit_at_once = std::size_t{1} << 14;

/// Moves further samples to where they are lit.
void lift(const Frame& frame, LitSamples& samples) {
  const VisiblePoints& from = samples.points;
  VisiblePoints& to = samples.lifted;
  to.triangles.clear();
  if (!frame.lifts_points()) return;
  to.width = from.width, to.height = from.height, to.seen_from = from.seen_from;
  to.triangles = from.triangles;
  to.positions.resize(from.positions.size());
  to.tiles.clear();
  parallel::parallel_ranges(to.triangles.size(), lit_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      if (to.triangles[i] != no_triangle) to.positions[i] = from.positions[i];
  });
  const TriangleView smooth = frame.smooth_triangles();
  lift_visible_points(smooth, to);
  points::make_point_tiles(to, smooth, *to.tiles);
}

void fill_levels(const std::vector<float>& fractions, ShadowMask& out) {
  out.resize(fractions.size());
  parallel::parallel_ranges(out.size(), lit_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out[i] = in_levels(fractions[i]);
  });
}

}  // namespace

TriangleView Lighter::traced_triangles(const Frame& frame, const DrawnLight& light) {
  const FrameGeometry& geometry = frame.input.geometry;
  TriangleView triangles = casters_of(frame.scene.scene, geometry, light, casters_);
  if (frame.lifts_points()) triangles.normals = geometry.normals;
  // The same number for further samples, and for all lights with the same casters: tracers then use what they
  // have made of these triangles.
  if (triangles.casts_shadow.data() == geometry.casts_shadow.data()) triangles.version = frame.number;
  return triangles;
}

Expected<void> Lighter::occlude(const Frame& frame, const AoProgress& progress, LitSamples& at,
                                FrameResult* told) {
  if (auto done = ambient_.compute(frame.scene.scene, frame.input.geometry, at.lit_at(), at.normals,
                                   frame.settings.ao, at.openness, progress, frame.stop);
      !done || told == nullptr)
    return done;
  told->ao = ambient_.stats();
  told->timings.ao_build_ms = ambient_.timings().ao_build_ms;
  told->timings.ao_ms = ambient_.timings().ao_ms;
  told->notes.insert(told->notes.end(), ambient_.notes().begin(), ambient_.notes().end());
  return {};
}

Expected<void> Lighter::trace_point(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                    SampleLight& out, Told told) {
  HardShadowConfig config = frame.settings.hard;
  config.contact = at.contact;
  config.count_pixel_nodes = told.mask != nullptr && frame.settings.diagnostics;
  if (!hard_.trace_shadow_mask(at.lit_at(), traced_triangles(frame, light),
                               shadow_light(light.light, light.placed), config, out.mask, frame.stop))
    return base::stopped();
  if (told.mask == nullptr) return {};
  told.result->methods.push_back({light.number, hard_.ran()});
  told.result->stats += hard_.stats();
  add_shadow_stages(told.result->timings, hard_.timings());
  told.mask->nodes.assign(hard_.pixel_nodes().begin(), hard_.pixel_nodes().end());
  return {};
}

Expected<void> Lighter::trace_tint(const Frame& frame, const DrawnLight& light, const LitSamples& at,
                                   SampleLight& out) {
  const RenderSettings& settings = frame.settings;
  const SeeThroughSurfaces surfaces = frame.see_through();
  const TriangleView triangles = traced_triangles(frame, light);
  TintConfig config;
  config.simd = settings.hard.simd;
  config.own_irradiance = settings.soft_points > 0 || settings.soft.error_255 > 0;
  config.error_255 = settings.soft.error_255;
  config.same_surfaces = std::exchange(tint_has_surfaces_, true);
  config.contact = at.contact;
  const bool done =
      light.area ? tint_.trace(at.lit_at(), at.normals, triangles, surfaces, *light.area, out.soft, config,
                               out.tint.mask, frame.stop)
                 : tint_.trace(at.lit_at(), triangles, surfaces, shadow_light(light.light, light.placed),
                               out.mask, config, out.tint.mask, frame.stop);
  return done ? Expected<void>() : Expected<void>(base::stopped());
}

Expected<void> Lighter::light_centres(const Frame& frame, const AoProgress& progress, LitSamples& at,
                                      FrameResult& result) {
  const bool shadows = frame.settings.shadows != ShadowMode::none;
  tint_has_surfaces_ = groups_changed_ = false;
  at.begin(frame.lights.size(), shadows && frame.has_glass() ? at.points.triangles.size() : 0);
  if (frame.has_occlusion()) {
    if (auto done = occlude(frame, progress, at, &result); !done) return done;
  }
  result.masks.resize(shadows ? frame.lights.size() : 0);
  for (std::size_t i = 0; i < result.masks.size(); ++i) {
    if (stop_requested(frame.stop)) return base::stopped();
    const DrawnLight& light = frame.lights[i];
    SampleLight& out = at.lights[i];
    LightMask& mask = result.masks[i];
    mask.light = light.number;
    const Told told{&result, &mask};
    if (auto done =
            light.area ? trace_area(frame, light, at, out, told) : trace_point(frame, light, at, out, told);
        !done)
      return done;
    base::Stopwatch watch;
    if (light.area) fill_levels(out.soft.visible_fraction, out.mask);
    result.timings.writeback_ms += watch.lap_ms();
    if (!frame.has_glass()) continue;
    if (!light.area) {
      if (auto done = trace_tint(frame, light, at, out); !done) return done;
      result.timings.tint_ms += watch.lap_ms();
    }
    out.tint.spread();
  }
  return {};
}

Expected<void> Lighter::light(const Frame& frame, LightKinds kinds, LitSamples& at) {
  const bool without_areas = kinds == LightKinds::points || kinds == LightKinds::masks;
  const bool shadows = frame.settings.shadows != ShadowMode::none;
  const bool tinted = shadows && kinds != LightKinds::masks && frame.has_glass();
  at.begin(frame.lights.size(), tinted ? at.points.triangles.size() : 0);
  lift(frame, at);
  for (std::size_t i = 0; shadows && i < frame.lights.size(); ++i) {
    if (stop_requested(frame.stop)) return base::stopped();
    const DrawnLight& light = frame.lights[i];
    if (light.area ? without_areas : kinds == LightKinds::areas) continue;
    SampleLight& out = at.lights[i];
    if (auto done =
            light.area ? trace_area(frame, light, at, out, {}) : trace_point(frame, light, at, out, {});
        !done)
      return done;
    if (!tinted) continue;
    if (!light.area) {
      if (auto done = trace_tint(frame, light, at, out); !done) return done;
    }
    out.tint.spread();
  }
  return without_areas || !frame.has_occlusion() ? Expected<void>() : occlude(frame, {}, at, nullptr);
}

}  // namespace tenebra::render
