// The opponent that a rival would bring: from triangle ids to the masks of all lights, as lean as one writes
// it on Embree. Points in float from the triangles' planes, sixteen at a time, shadow rays of all lights
// while they are in the nearest cache; nothing but masks is written.
#pragma once

#include "bench/common/packet_tracer.h"

namespace tenebra::bench {

/// What masks are made of.
struct MaskTask {
  std::span<const std::uint32_t> ids;  ///< width * height
  int width, height;
  const ViewRays& view;
  TriangleView triangles;
  std::span<const ShadowLight> lights;
  float wide_m;  ///< no smaller than the scene
  SimdLevel simd;
};

/// `masks`: one for each light, 255 where it is seen. On the threads that the caller allows.
void trace_masks(const MaskTask& task, const EmbreeTree& tree, const PacketPlan& plan,
                 std::span<ShadowMask> masks);

}  // namespace tenebra::bench
