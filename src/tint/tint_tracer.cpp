#include <tenebra/tint.h>

#include <cassert>
#include <utility>

#include "base/names.h"
#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/positions.h"
#include "tint/hard_tint.h"
#include "tint/soft_tint.h"

namespace tenebra {

namespace {

constexpr base::Names<SeeThrough, 3> names = {{
    {SeeThrough::tint, "tint"},
    {SeeThrough::cast, "cast"},
    {SeeThrough::ignore, "ignore"},
}};

}  // namespace

std::string_view see_through_name(SeeThrough see_through) {
  return base::name_in(names, see_through);
}

std::optional<SeeThrough> see_through_from_name(std::string_view name) {
  return base::value_in(names, name);
}

void cast_see_through(SeeThrough see_through, FrameGeometry& geometry) {
  if (see_through == SeeThrough::tint) return;
  for (std::size_t i = 0; i < geometry.see_through.size(); ++i) {
    if (geometry.see_through[i] != 1) continue;
    geometry.see_through[i] = 2;
    geometry.casts_shadow[i] = see_through == SeeThrough::cast;
  }
}

SeeThroughSurfaces see_through_surfaces(const Scene& scene, const FrameGeometry& geometry,
                                        const SurfaceCoordinates& coordinates) {
  return {&scene,
          geometry.see_through,
          geometry.materials,
          {coordinates.texture_coordinates[0], coordinates.texture_coordinates[1]},
          coordinates.colors};
}

struct TintTracer::State {
  tint::Panes panes;
  tint::PaneTree tree;
  tint::HardTint hard;
  tint::SoftTint soft;
  points::PointTiles own_tiles;  ///< of points that came without
  VisiblePoints positions;       ///< where those that are given have none
  TintStats stats;

  /// False: nothing is see-through.
  bool begin(const SeeThroughSurfaces& from, const TriangleView& triangles, const TintConfig& config,
             TintMask& out);
};

bool TintTracer::State::begin(const SeeThroughSurfaces& from, const TriangleView& triangles,
                              const TintConfig& config, TintMask& out) {
  assert(from.see_through.empty() || from.see_through.size() == triangles.triangles.size());
  out.pixels.clear();
  out.factors.clear();
  if (!config.same_surfaces) {
    panes.reset(from, triangles);
    tree.update(panes.ids(), triangles);
  }
  tree.use(config.simd);
  stats = {};
  stats.triangles = panes.ids().size();
  return !panes.ids().empty();
}

TintTracer::TintTracer() : state_(std::make_unique<State>()) {}
TintTracer::TintTracer(TintTracer&&) noexcept = default;
TintTracer& TintTracer::operator=(TintTracer&&) noexcept = default;
TintTracer::~TintTracer() = default;

const TintStats& TintTracer::stats() const {
  return state_->stats;
}

bool TintTracer::trace(const VisiblePoints& seen, const TriangleView& triangles,
                       const SeeThroughSurfaces& surfaces, const ShadowLight& light, const ShadowMask& mask,
                       const TintConfig& config, TintMask& out, const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  State& s = *state_;
  base::Stopwatch watch;
  if (!s.begin(surfaces, triangles, config, out)) return true;
  const VisiblePoints& points = points::with_positions(seen, triangles, s.positions);
  const bool ready = !points.tiles.empty();
  if (!ready) points::make_point_tiles(points, triangles, s.own_tiles);
  const bool done = s.hard.trace(points, ready ? *points.tiles : s.own_tiles, triangles, s.panes, s.tree,
                                 light, mask, config, out, s.stats, stop);
  s.stats.ms = watch.lap_ms();
  return done;
}

bool TintTracer::trace(const VisiblePoints& seen, std::span<const glm::vec3> normals,
                       const TriangleView& triangles, const SeeThroughSurfaces& surfaces,
                       const AreaLight& light, const SoftMask& mask, const TintConfig& config, TintMask& out,
                       const StopFlag* stop) {
  const parallel::FloatEnvironment ieee;
  State& s = *state_;
  base::Stopwatch watch;
  if (!s.begin(surfaces, triangles, config, out)) return true;
  const VisiblePoints& points = points::with_positions(seen, triangles, s.positions);
  const bool done =
      s.soft.trace(points, normals, triangles, s.panes, s.tree, light, mask, config, out, s.stats, stop);
  s.stats.ms = watch.lap_ms();
  return done;
}

}  // namespace tenebra
