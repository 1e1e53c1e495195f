#include "bench/soft/soft_trees.h"

#include <cmath>

#include <tenebra/soft_shadows.h>
#include "base/stopwatch.h"

namespace tenebra::bench {

TreeCost tree_cost(const SoftView& view, const VisiblePoints& points, const SoftShadowConfig& config) {
  SoftShadowTracer tracer;
  SoftMask mask;
  base::Stopwatch watch;
  tracer.trace(points, view.frame.normals, view.frame.triangles(), view.light, config, mask);
  TreeCost cost;
  cost.ms = watch.lap_ms();
  const SoftStats& s = tracer.stats();
  cost.nodes = static_cast<double>(s.tree_nodes), cost.bytes = static_cast<double>(s.peak_tree_bytes);
  cost.by_tree = static_cast<double>(s.points_bsp), cost.clipped = static_cast<double>(s.points_clip);
  const FrameTimings& t = tracer.timings();
  cost.shaft_ms = t.shaft_ms, cost.init_ms = t.init_ms, cost.query_ms = t.query_ms + t.irradiance_ms;
  for (const auto* values : {&mask.visible_fraction, &mask.irradiance})
    for (const float v : *values) cost.finite = cost.finite && std::isfinite(v) && v >= 0;
  return cost;
}

}  // namespace tenebra::bench
