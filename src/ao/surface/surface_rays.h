// Where rays from a point of a body's surface meet the body itself.
#pragma once

#include "ao/cast/ray_kernels.h"
#include "ao/surface/surface_layout.h"
#include "trees/triangle_bvh.h"

namespace tenebra::ao {

class SurfaceRays {
public:
  static constexpr int rays = 256;  ///< per point, about its shading normal

  /// `reach`: where occlusion has fallen off to nothing, in units of the shape. Keeps references to both.
  SurfaceRays(const ObjectShape& shape, const trees::TriangleBvh& casters, double reach);

  struct Seen {
    float occlusion = 0;  ///< 0..1
    float nearest = 0;    ///< distance of what is hit first, by grazing rays, too; at most the reach
    bool buried = false;  ///< most rays see the back of something
  };
  Seen look(const SurfacePoint& point, const RayKernels& kernels) const;

private:
  const ObjectShape& shape_;
  const trees::TriangleBvh& casters_;
  float reach_;
  float lift_;
  RayPattern pattern_, grazing_;
};

}  // namespace tenebra::ao
