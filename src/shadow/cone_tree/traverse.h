// Triangles through the cone tree. Olsson and Assarsson 2011, sections 3.2 to 3.4 and 4.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "shadow/cone_tree/cone_tree.h"
#include "shadow/decision/triangle_planes.h"

namespace tenebra::shadow {

/// Triangles that each node was tested with: levels as in ConeTree, one count for each node. Their sum is
/// TraceStats::nodes.
using NodeTests = std::vector<std::vector<std::uint32_t>>;

struct TraversalFlags {
  bool spheres = false;       ///< bounding spheres against cones, as in the earlier work; else section 3.2
  bool early_accept = false;  ///< section 3.3
  bool directional = false;
};

/// What a traversal reads, and the one tree it writes to: live bits of packets, bounds of finished nodes.
struct Traversal {
  TraversalFlags flags;
  const TriangleSet* set = nullptr;
  const ShadowRays* rays = nullptr;
  ConeTree* tree = nullptr;
  const RaySource* source = nullptr;
  const TriangleView* triangles = nullptr;
  std::span<const glm::dvec3> positions;
  ContactRule contact = ContactRule::triangle_ids;
  NodeTests* node_tests = nullptr;  ///< added to if given; of the size of the tree
  const StopFlag* stop = nullptr;   ///< if it is requested, the rest is not done
};

/// Places in TriangleSet::planes. A list's storage has room for one more than it holds.
struct TriangleList {
  const std::uint32_t* places = nullptr;
  std::size_t size = 0;
};

/// Scratch of one thread: four lists for each level.
struct TraversalScratch {
  std::vector<std::vector<std::uint32_t>> lists;
};

/// Code for one instruction set.
struct TraversalKernels {
  /// Tests the four nodes of block `block` of level `level` against the triangles of `list`; appends each
  /// triangle's place to out[lane] of the nodes it may meet and counts out_size[lane]. Lists need room for
  /// list.size + 1.
  void (*filter)(const Traversal&, std::size_t level, std::size_t block, TriangleList list,
                 std::uint32_t* const out[4], std::size_t out_size[4], TraceStats&) = nullptr;
  /// Takes `list` through the whole subtree of node `node` of level `level`, whose own test it has passed.
  void (*descend)(const Traversal&, std::size_t level, std::size_t node, TriangleList list, TraversalScratch&,
                  TraceStats&) = nullptr;
};
/// `level`: one for which simd_level_supported() holds, or automatic.
TraversalKernels traversal_kernels(SimdLevel level);

/// Takes the triangles at `places` through the tree on all cores. Memory is bounded: at most 65,536 triangles
/// are in flight at once, in lists of that size for each level and thread. Counts do not depend on the number
/// of threads.
void traverse(const Traversal& traversal, const TraversalKernels& kernels,
              std::span<const std::uint32_t> places, std::vector<TraversalScratch>& scratch,
              TraceStats& stats);

}  // namespace tenebra::shadow
