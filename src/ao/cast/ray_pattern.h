// The rays of ambient occlusion: cosine-weighted directions about +z by the concentric map, sixteen close
// ones to a batch, and how they are turned about a point's normal.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include <tenebra/simd_level.h>
#include "trees/ray_batch.h"

namespace tenebra::ao {

/// Directions about +z, unit; the last batch is filled up with zeros, which meet nothing.
struct RayPattern {
  struct alignas(64) Batch {
    float x[trees::batch_size], y[trees::batch_size], z[trees::batch_size];
  };
  int rays = 0;
  std::vector<Batch> batches;
};

/// `rays` points of a Fibonacci lattice in the square, mapped to the hemisphere; neighbours share a batch.
/// (With 16 rays a quarter less noise than a Hammersley set, a tenth less than a lattice that starts at 0.)
/// The lattice is shifted by `shift` in the square, wrapping round at its edges.
RayPattern make_ray_pattern(int rays, const glm::dvec2& shift = glm::dvec2(0.0));

/// Right-handed unit axes; z is the normal.
struct RayAxes {
  glm::vec3 x, y, z;
};

/// Axes about `normal`, turned by an angle that belongs to the cell of size `cell` in which `position` (in
/// the receiver's own space) lies: a point keeps its rays whatever the camera does.
RayAxes turned_axes(const glm::vec3& normal, const glm::dvec3& position, double cell);

/// Code for one instruction set. Bits do not depend on it.
struct FanKernels {
  /// Rays of a point: the pattern in `axes`, those below the plane of `face` mirrored at it, so that a
  /// surface does not hide itself where its shading normal leans. One RayBatch for each batch of the pattern.
  void (*spread)(const RayPattern& pattern, const RayAxes& axes, const glm::vec3& face,
                 const glm::vec3& origin, trees::RayBatch* out) = nullptr;
  /// Sum of max(0, 1 - distance / reach) over whole batches.
  float (*fall_off)(const float* distances, int batches, float reach) = nullptr;
};
FanKernels fan_kernels(SimdLevel level);

}  // namespace tenebra::ao
