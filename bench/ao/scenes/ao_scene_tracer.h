// The opponent's rays through Embree: coherent packets of neighbouring pixels.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bench/ao/scenes/ao_scene_planes.h"
#include "bench/ao/scenes/ao_scene_views.h"
#include "bench/common/embree_tree.h"

namespace tenebra::bench {

/// A view, its triangles under one of Embree's trees.
class AoSceneTracer {
public:
  AoSceneTracer(const AoSceneView& view, TreeKind kind);

  /// Lets the tree follow what moved since the frame before; returns the time in milliseconds, 0 where
  /// nothing moved.
  double follow_ms();

  /// Openness of a grid's pixels, to `values` as `layout` lies. On all threads.
  void trace(const AoScenePattern& pattern, const PixelGrid& grid, const PlaneLayout& layout,
             float* values) const;
  /// Of some pixels of the picture, to values[pixel].
  void trace(const AoScenePattern& pattern, std::span<const std::size_t> pixels, float* values) const;

  /// How Embree is told to take packets.
  void set_order(ao::EmbreeQuery::Rays order) { order_ = order; }

private:
  void trace_tile(const AoScenePattern& pattern, const PixelGrid& grid, const PlaneLayout& layout,
                  glm::ivec2 at, float* values) const;
  void take(std::size_t pixel, int lane, AoPointPacket& points) const;
  void begin(AoPointPacket& points) const;
  void cast(const AoPointPacket& points, const PatternRow* rows, int rays, float* open) const;
  template <class Hits, class Code>
  void cast_all(const AoPointPacket& points, const PatternRow* rows, int rays, const Code& code,
                float* sums) const;

  const AoSceneView& view_;
  bool still_;  ///< nothing moves from the frame before
  TreeVertices vertices_;
  EmbreeTree tree_;
  AoSceneKernels kernels_ = ao_scene_kernels();
  ao::EmbreeQuery::Rays order_ = ao::EmbreeQuery::coherent;
  int packet_;  ///< rays that Embree traces at once
  float least_lift_;
  std::vector<glm::ivec2> lanes_;  ///< pixels of a tile
};

/// The tree that follows and traces a few rays soonest: of the moving ones where something moves, else the
/// best.
std::unique_ptr<AoSceneTracer> best_tracer(const AoSceneView& view, TreeKind& chosen);

}  // namespace tenebra::bench
