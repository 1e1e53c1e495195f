// Area lights as a few points, each with exact hard shadows: a quick replacement for exact soft shadows.
// There is no noise, but a penumbra has as many steps as there are points; docs/trade.md says how far off it
// is.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <tenebra/hard_shadows.h>
#include <tenebra/soft_shadows.h>

namespace tenebra::render {

/// `count` points on the light, spread evenly: each stands for the same area (a Fibonacci lattice). Of a sun
/// they are directions.
std::vector<glm::vec3> points_on_light(const AreaLight& light, int count);

/// Buffers kept from frame to frame.
class LightPointShadows {
public:
  /// As SoftShadowTracer::trace with `light` as `count` points; `normals`: one per pixel. The same bits for
  /// any thread count, instruction set and variant. Returns false, with `out` unspecified, if `stop` was
  /// requested before the end.
  bool trace(const VisiblePoints& points, std::span<const glm::vec3> normals, const TriangleView& triangles,
             const AreaLight& light, int count, const HardShadowConfig& config, SoftMask& out,
             const StopFlag* stop = nullptr);

  const TraceStats& stats() const { return stats_; }  ///< of the last call, summed over the points
  const FrameTimings& timings() const { return timings_; }

private:
  ShadowTracer tracer_;
  std::array<ShadowMask, 8> masks_;  // of the points that are added at once
  std::vector<glm::vec3> places_;
  TraceStats stats_;
  FrameTimings timings_;
};

}  // namespace tenebra::render
