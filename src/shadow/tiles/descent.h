// Triangles against rays: the tree of clusters and the forest of rays, descended together. Of two nodes that
// meet, that of the triangles is descended, beside the deepest node of rays that holds all rays it may meet;
// where these lie much wider than the triangles, that of the rays. So the work depends on the pairs that come
// near each other: few large triangles among dense rays, or many tiny ones among sparse rays.
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/stop_flag.h>
#include "shadow/tiles/position_cache.h"
#include "shadow/tiles/ray_forest.h"
#include "shadow/tiles/triangle_clusters.h"

namespace tenebra::shadow {

/// What a descent reads, and the forest it writes to: live rays and counts of tests.
struct Descent {
  const ClusterTree& clusters;
  RayForest& forest;
  const RaySource& source;  ///< directional ones: distant
  const TriangleView& triangles;
  const VisiblePoints& points;
  const points::PointTiles& tiles;  ///< of the same points
  ContactRule contact;
  bool cull_front;
  std::vector<std::array<std::uint32_t, 16>>* tile_tests;  ///< null, or counts: one per node of level 0
  const StopFlag* stop;  ///< may be null; if it is requested, the rest is not done
};

/// A cluster's triangles as seen from the light: planes m.p - d relative to the source's origin as in
/// TrianglePlanes, sixteen at a time.
struct alignas(64) ClusterPlanes {
  double mx[4][16], my[4][16],
      mz[4][16];    ///< unit; 0..2: through the light and an edge; 3: own plane
  double d[4][16];  ///< edges: 0 where the origin is the light; own plane: tau of the triangle included
  float fx[4][16], fy[4][16], fz[4][16], fd[4][16];  ///< the same in float
  float rho[16];          ///< relative errors, the largest of the four planes', rounded up
  float own_rho[16];      ///< that of the own plane
  float reach[16];        ///< >= largest |vertex - origin|
  float tau[16];          ///< rounding tolerance, rounded up
  std::uint32_t valid;    ///< bit i: triangle i may block something
  std::uint32_t edge_on;  ///< bit i: it lies in a plane through the light, or has no area
  std::uint32_t turned;   ///< bit i: its side (TrianglePlanes) is -1, not +1
};

/// Scratch of one thread.
struct DescentScratch {
  ClusterPlanes planes;
  std::vector<std::uint32_t> edge_on;  ///< triangles that were found so, as often as they were
  PositionCache positions;

  void begin_trace() {
    edge_on.clear();
    positions.clear();
  }
};

/// Which of a cluster's triangles block rays of one box. Bits of triangles.
struct ClusterVerdict {
  std::uint32_t met;      ///< may block some of them
  std::uint32_t covered;  ///< block all of them, but their own
};

/// Code for one instruction set.
struct DescentKernels {
  /// Takes all clusters through the tree of root `root`.
  void (*descend)(const Descent&, std::uint32_t root, DescentScratch&, TraceStats&) = nullptr;
  /// The tests that a descent makes on its way, of one cluster with one box, to be looked at by themselves.
  /// `boxes`: lane 0 is the cluster's; `face`: of the cube, where `distant` is null; `tau`: 0 without contact
  /// rule.
  ClusterVerdict (*meet)(const TriangleCluster& cluster, const BoxNode& boxes, const RaySource& source,
                         int face, const DistantFace* distant, const FaceBox& rays, float tau) = nullptr;
};
/// `level`: one for which simd_level_supported() holds, or automatic.
DescentKernels descent_kernels(SimdLevel level);

}  // namespace tenebra::shadow
