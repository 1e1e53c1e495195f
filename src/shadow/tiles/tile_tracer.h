// The variant Tiles: rays in tiles of neighbouring pixels, triangles in clusters of neighbouring triangles, a
// tree over each, descended together. Compared with the paper's method, it sorts thousands of squares instead
// of a million rays, bounds them by boxes on a cube's faces (cones of rectangular section with their apex at
// the light) instead of round cones, and looks at sixteen triangles or nodes at once. Floats alone decide
// first, then planes through the light in double; the last stages, and with them the mask, are the same:
// double, then exact signs.
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/stop_flag.h>
#include <memory>
#include "shadow/tiles/descent.h"

namespace tenebra::shadow {

/// Buffers kept from frame to frame, the order of the triangles among them.
class TileTracer {
public:
  /// Fills `mask`, `stats` and `timings` as ShadowTracer does. False, with nothing of use in them, where the
  /// method does not apply: points that are less than 1e-15 from the light or 1e15 and more apart, and more
  /// than most_vertices; or if `stop` was requested.
  bool trace(const VisiblePoints& points, const TriangleView& triangles, const ShadowLight& light,
             const HardShadowConfig& config, ShadowMask& mask, TraceStats& stats, FrameTimings& timings,
             const StopFlag* stop);

  void share_triangles(TileTracer& other) { clusters_ = other.clusters_; }
  /// What trace() does first with the triangles; nothing for more than most_vertices. False: stopped.
  bool follow(const TriangleView& triangles, SimdLevel simd, const StopFlag* stop) {
    return triangles.positions.size() > most_vertices ? !stop_requested(stop)
                                                      : clusters_->update(triangles, simd, stop);
  }

  /// After a call: node tests per pixel; those of a node are divided equally among the rays below it.
  void spread_tests(int width, int height, std::vector<float>& out) const;

private:
  const points::PointTiles& tiles_of(const VisiblePoints& points, const TriangleView& triangles);
  void order_roots(std::size_t roots);
  void descend(const Descent& descent, SimdLevel simd, TraceStats& stats);

  points::PointTiles own_tiles_;  ///< of points that came without
  std::vector<std::array<std::uint32_t, 16>> tile_tests_;
  std::shared_ptr<ClusterTree> clusters_ = std::make_shared<ClusterTree>();
  RayForest forest_;
  ForestScratch forest_scratch_;
  std::vector<DescentScratch> scratch_;
  std::vector<std::uint64_t> live_parts_;  ///< room for write_live_rays()
  std::vector<std::uint64_t> root_tests_;  ///< of the last call, one per root
  std::vector<TraceStats> root_stats_;     ///< scratch of descend: of each root
  std::vector<std::uint32_t> root_order_;  ///< in which they are descended
};

}  // namespace tenebra::shadow
