// The rays of a frame's receivers, and what their hits add up to.
#pragma once

#include "ao/cast/ray_kernels.h"
#include "ao/receivers/receivers.h"

namespace tenebra::ao {

class PointRays {
public:
  /// `reach`: metres at which nothing occludes any more. Keeps a reference to `objects` until the next call.
  void begin_frame(const SceneObjects& objects, int rays, double reach, const RayKernels& kernels);

  float reach() const { return static_cast<float>(reach_); }
  std::size_t batches() const { return pattern_.batches.size(); }  ///< per receiver
  int rays() const { return pattern_.rays; }                       ///< per receiver
  /// Batches of the receiver's rays: they belong to its place on its object, not to the camera.
  void spread(const Receiver& receiver, trees::RayBatch* out) const;
  /// Hidden share, 0..1, by the distances of all batches; without a hit a distance is the reach.
  float hidden(const float* distances) const;

private:
  const SceneObjects* objects_ = nullptr;
  RayPattern pattern_;
  RayKernels kernels_;
  double reach_ = 0;
  float lift_ = 0;
};

}  // namespace tenebra::ao
