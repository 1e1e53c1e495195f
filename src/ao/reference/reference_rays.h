// The reference: the same rays cast through all of a frame's triangles by a well-known ray caster, Embree. A
// build without it says so.
#pragma once

#include <memory>
#include <span>

#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include "trees/ray_batch.h"

namespace tenebra::ao {

class ReferenceRays {
public:
  /// Over the triangles that cast. Fails, with one sentence, in a build without a ray caster, and with
  /// "stopped".
  static Expected<ReferenceRays> create(const TriangleView& triangles, const StopFlag* stop = nullptr);
  ReferenceRays(ReferenceRays&&) noexcept;
  ReferenceRays& operator=(ReferenceRays&&) noexcept;
  ~ReferenceRays();

  /// distance[i] = where ray i first meets a triangle before distance[i]; else left as it is.
  void nearest_hits(const trees::RayBatch& rays, float* distances) const;

private:
  struct State;
  explicit ReferenceRays(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::ao
