// Triangles against rays: the tree of clusters and the forest of rays, descended together. Of two nodes
// that meet, that of the triangles is descended, beside the deepest node of rays that holds all rays it may
// meet; where these lie much wider than the triangles, that of the rays. So the work follows the pairs that
// come near each other: few large triangles among dense rays, or many tiny ones among sparse rays.
#pragma once

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include "shadow/tiles/ray_forest.h"
#include "shadow/tiles/triangle_clusters.h"

namespace tenebra::shadow {

/// What a descent reads, and the forest it writes to: live rays and counts of tests.
struct Descent {
  const ClusterTree& clusters;
  RayForest& forest;
  const RaySource& source;  ///< not directional
  const TriangleView& triangles;
  const VisiblePoints& points;
  const points::PointTiles& tiles;  ///< of the same points
  ContactRule contact;
  bool cull_front;
  std::vector<std::array<std::uint32_t, 16>>* tile_tests;  ///< null, or counts: one per node of level 0
};

/// A cluster's triangles as seen from the light: planes m.p - d relative to the light as in TrianglePlanes,
/// sixteen at a time.
struct alignas(64) ClusterPlanes {
  double mx[4][16], my[4][16],
      mz[4][16];                          ///< unit; 0..2: through the light and an edge (d = 0); 3: own plane
  double d[16];                           ///< own plane, tau of the triangle included
  float fx[4][16], fy[4][16], fz[4][16];  ///< the same in float
  float fd[16];                           ///< d
  float rho[16];                          ///< relative errors, the largest of the four planes', rounded up
  float reach[16];                        ///< >= largest |vertex - light|
  std::uint32_t valid;                    ///< bit i: triangle i may block something
  std::uint32_t edge_on;                  ///< bit i: it lies in a plane through the light, or has no area
};

/// Scratch of one thread.
struct DescentScratch {
  ClusterPlanes planes;
  std::vector<std::uint32_t> edge_on;  ///< triangles that were found so, as often as they were
};

/// Code for one instruction set.
struct DescentKernels {
  /// Takes all clusters through the tree of root `root`.
  void (*descend)(const Descent&, std::uint32_t root, DescentScratch&, TraceStats&) = nullptr;
};
/// `level`: one that simd_level_supported, or automatic.
DescentKernels descent_kernels(SimdLevel level);

}  // namespace tenebra::shadow
