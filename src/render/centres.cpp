#include "render/centres.h"

#include <algorithm>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/point_tiles.h"

namespace tenebra::render {
namespace {

constexpr std::size_t centres_at_once = std::size_t{1} << 14;

void points_from_depth(const ViewRays& view, const visibility::VisibleIds& seen, VisiblePoints& points) {
  const std::size_t width = static_cast<std::size_t>(seen.width),
                    height = static_cast<std::size_t>(seen.height);
  points.width = seen.width;
  points.height = seen.height;
  points.triangles = seen.ids;
  points.sides.clear();
  points.seen_from = view;
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

/// Whether normals are asked for: by lights with an area, and ambient occlusion.
bool needs_normals(const Frame& frame) {
  return frame.has_areas() || frame.has_occlusion();
}

PointLayout layout_for(const Frame& frame) {
  const RenderSettings& settings = frame.settings;
  const bool others = settings.shadows != ShadowMode::none &&
                      std::any_of(frame.lights.begin(), frame.lights.end(),
                                  [](const DrawnLight& light) { return !light.area; });
  const bool traced = others || (frame.has_areas() && settings.soft_points > 0);
  if (!traced || settings.hard.variant != Variant::tiles) return PointLayout::rows;
  return needs_normals(frame) || frame.has_glass() ? PointLayout::rows_and_tiles : PointLayout::tiles;
}

/// The points lifted to the smooth surfaces; the normals are those of the points before.
void find_lifted_points(const Frame& frame, const visibility::VisibleIds& seen, LitSamples& out) {
  const ViewRays& view = frame.input.view;
  const PointLayout layout = layout_for(frame);
  const TriangleView smooth = frame.smooth_triangles();
  if (!needs_normals(frame))
    return compute_visible_points(seen.ids, seen.width, seen.height, view, smooth, out.points, layout);
  compute_visible_points(seen.ids, seen.width, seen.height, view, frame.triangles(), out.points);
  compute_shading_normals(out.points, frame.input.geometry.normals, frame.triangles(), out.normals);
  lift_visible_points(smooth, out.points);
  if (layout != PointLayout::rows) points::make_point_tiles(out.points, smooth, *out.points.tiles);
}

void find_points(const Frame& frame, const visibility::VisibleIds& seen, LitSamples& out) {
  const ViewRays& view = frame.input.view;
  const bool from_depth = frame.settings.samples == SampleSource::depth;
  out.contact = from_depth ? ContactRule::none : frame.settings.hard.contact;
  if (from_depth) return points_from_depth(view, seen, out.points);
  if (frame.lifts_points()) return find_lifted_points(frame, seen, out);
  const TriangleView triangles = frame.triangles();
  compute_visible_points(seen.ids, seen.width, seen.height, view, triangles, out.points, layout_for(frame));
  if (needs_normals(frame))
    compute_shading_normals(out.points, frame.input.geometry.normals, triangles, out.normals);
}

/// 1 where a mask is lit, else 0.
std::vector<float> fractions_of(const ShadowMask& mask) {
  std::vector<float> out(mask.size());
  parallel::parallel_ranges(out.size(), centres_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out[i] = mask[i] != 0 ? 1.0f : 0.0f;
  });
  return out;
}

}  // namespace

void find_centre_points(const Frame& frame, Centres& centres, FrameTimings& timings) {
  base::Stopwatch watch;
  find_points(frame, centres.seen, centres.lit);
  timings.points_ms = watch.lap_ms();
}

void hand_over_masks(const Frame& frame, Centres& centres, FrameResult& result) {
  base::Stopwatch watch;
  const int width = centres.seen.width, height = centres.seen.height;
  centres.factors.clear();
  for (std::size_t i = 0; i < result.masks.size(); ++i) {
    SampleLight& light = centres.lit.lights[i];
    LightMask& to = result.masks[i];
    if (frame.lights[i].area) {
      to.visible_fraction = {width, height, 1, std::move(light.soft.visible_fraction)};
    } else if (frame.settings.shadows == ShadowMode::soft) {
      to.visible_fraction = {width, height, 1, fractions_of(light.mask)};
    }
    if (frame.settings.shadows == ShadowMode::soft && frame.settings.error_maps) {
      to.error = {width, height, 1, std::move(to.error.pixels)};
      to.error.pixels.resize(light.mask.size());  // the rest is exact
    }
    to.mask = {width, height, 1, std::move(light.mask)};
    to.tint = std::move(light.tint.mask);
  }
  result.timings.writeback_ms += watch.lap_ms();
}

void reuse_masks(std::vector<LightMask>& masks, Centres& centres) {
  for (std::size_t i = 0; i < std::min(masks.size(), centres.lit.lights.size()); ++i) {
    centres.lit.lights[i].mask = std::move(masks[i].mask.pixels);
    centres.lit.lights[i].soft.visible_fraction = std::move(masks[i].visible_fraction.pixels);
  }
  masks.clear();
}

}  // namespace tenebra::render
