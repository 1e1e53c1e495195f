// Ambient occlusion of a set of receivers from fields and samples: groups are shaded at once, the fields and
// samples that they lack are made, and those that lacked some are shaded again, until none does.
#pragma once

#include <tenebra/frame_timings.h>
#include "ao/presampled/group_shader.h"

namespace tenebra::ao {

/// Lists that are kept from frame to frame.
struct FieldRoom {
  std::vector<GroupShader> shaders;  ///< one for each thread
  std::vector<GroupReport> reports;  ///< one for each pending group, and more from before
  std::vector<int> pending, left;    ///< groups: of this round and of the next
  std::vector<int> own, reached;     ///< bodies and occluders that are needed
  std::vector<int> bodies, occluders;
  std::vector<MissingSample> samples;  ///< like these, missing
};

/// What a pass works on, and what it adds to.
struct FieldPass {
  Casters& casters;
  FieldOccluders& occluders;
  Bodies& bodies;
  const PointRays& rays;
  RayKernels kernels;
  AoStats& stats;
  FrameTimings& timings;
  FieldRoom& room;

  /// Openness, 0..1, one per receiver; 1 where there is none. Fails with "stopped".
  Expected<void> run(const ReceiverSet& set, AoPart part, std::vector<float>& values,
                     const AoProgress& progress, const StopFlag* stop);

private:
  void use(std::span<const GroupReport> reports);
  Expected<void> supply(std::span<const GroupReport> reports, const AoProgress& progress,
                        const StopFlag* stop);
};

}  // namespace tenebra::ao
