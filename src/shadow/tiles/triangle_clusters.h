// Casting triangles in clusters of sixteen and an implicit sixteen-way tree of boxes over them: what the
// variant Tiles descends together with its ray tree. The order is found once (classes of size, then part by
// part, cut in halves); from frame to frame boxes are refitted, of clusters with a changed vertex or
// triangle.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/simd_level.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>

namespace tenebra::shadow {

inline constexpr std::uint32_t cluster_size = 16;
inline constexpr std::size_t most_vertices =
    (std::size_t{1} << 31) / sizeof(glm::vec3);  ///< of a ClusterTree

/// Corner k of triangle i is (x[k][i], y[k][i], z[k][i]), world space.
struct alignas(64) TriangleCluster {
  float x[3][cluster_size], y[3][cluster_size], z[3][cluster_size];
  std::uint32_t ids[cluster_size];
  std::uint32_t used = 0;  ///< bit i: triangle i is there, finite, and may block something
};

/// Where a cluster's corners stand in memory.
struct ClusterCorners {
  std::int32_t offset[3][cluster_size];  ///< bytes from the first vertex
  std::uint32_t first = 0;               ///< vertex
  std::uint32_t possible = 0;            ///< bit i: triangle i is there and has three different corners
};

/// Sixteen boxes, world space. An empty one has low = infinity, high = -infinity.
struct alignas(64) BoxNode {
  float low[3][cluster_size], high[3][cluster_size];
};

class ClusterTree {
public:
  /// Follows `triangles`: finds the order anew where their number, parts or casters changed, refits else.
  /// False if `stop` was requested: of no use until the next update.
  bool update(const TriangleView& triangles, SimdLevel simd, const StopFlag* stop);

  const std::vector<TriangleCluster>& clusters() const { return clusters_; }
  /// levels()[0]: node i holds the boxes of clusters 16 i ... 16 i + 15; levels()[k]: those of the nodes of
  /// level k - 1. The last level has one node. Empty without casters.
  const std::vector<std::vector<BoxNode>>& levels() const { return levels_; }
  std::uint64_t casters() const { return casters_; }
  /// Casters that are left out: two corners are the same vertex, or one is not finite.
  std::uint64_t without_area() const { return casters_ - used_; }
  std::size_t byte_count() const;

private:
  /// Vertices and triangles, in blocks, that a cluster was made from: [first, last].
  struct Origin {
    std::uint32_t first_vertex = 0, last_vertex = 0, first_triangle = 0, last_triangle = 0;
  };

  bool same_order(const TriangleView& triangles) const;
  void follow(const TriangleView& triangles, SimdLevel simd, const StopFlag* stop);
  void find_order(const TriangleView& triangles, const StopFlag* stop);
  bool triangles_changed(std::size_t cluster) const;
  bool vertices_changed(std::size_t cluster) const;
  void find_corners(const TriangleView& triangles, std::size_t cluster);
  void refit(const TriangleView& triangles, SimdLevel simd, bool all, const StopFlag* stop);

  std::vector<std::uint32_t> order_;  ///< ids; no_triangle: a gap
  std::vector<TriangleCluster> clusters_;
  std::vector<ClusterCorners> corners_;
  std::vector<Origin> origins_;
  std::vector<std::vector<BoxNode>> levels_;
  std::uint64_t casters_ = 0;
  std::uint64_t used_ = 0;      ///< of the casters
  std::vector<int> more_used_;  ///< scratch of refit: triangles in use below each node, over those before
  std::uint64_t version_ = 0;
  // What the last frame looked like.
  std::vector<glm::vec3> positions_;  ///< and one more, so that all can be read in fours of floats
  std::vector<glm::uvec3> triangles_;
  std::vector<std::uint8_t> casts_;
  std::vector<std::uint32_t> parts_;
  // Changed blocks before each: one more than there are blocks.
  std::vector<std::uint32_t> changed_vertices_, changed_triangles_;
};

}  // namespace tenebra::shadow
