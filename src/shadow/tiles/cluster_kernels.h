// Clusters follow their vertices, sixteen triangles at a time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/simd_level.h>
#include "shadow/tiles/triangle_clusters.h"

namespace tenebra::shadow {

/// Code for one instruction set; all give the same.
struct ClusterKernels {
  /// Corners of the cluster's triangles from positions[first + offset / 12 bytes] (of which four floats are
  /// read: another must follow the last); `used` loses those that are not finite. The box around the used
  /// ones becomes lane `lane` of `node`.
  void (*follow)(const glm::vec3* positions, const ClusterCorners& corners, TriangleCluster& cluster,
                 BoxNode& node, std::size_t lane) = nullptr;
};
ClusterKernels cluster_kernels(SimdLevel level);

}  // namespace tenebra::shadow
