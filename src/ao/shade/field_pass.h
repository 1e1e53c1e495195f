// Ambient occlusion of a set of receivers from fields and samples: groups are shaded at once, the fields and
// samples that they lack are made, and those that lacked some are shaded again, until none does.
#pragma once

#include <tenebra/frame_timings.h>
#include "ao/shade/group_shader.h"

namespace tenebra::ao {

/// What a pass works on, and what it adds to.
struct FieldPass {
  Occluders& occluders;
  Bodies& bodies;
  const PointRays& rays;
  AoKernels kernels;
  AoStats& stats;
  FrameTimings& timings;

  /// Open shares, 0..1, one per receiver; 1 where there is none. Fails with "stopped".
  Expected<void> run(const ReceiverSet& set, AoPart part, std::vector<float>& values,
                     const AoProgress& progress, const StopFlag* stop);

private:
  void use(const std::vector<GroupReport>& reports, std::vector<int>& reached);
  Expected<void> supply(const std::vector<GroupReport>& reports, const AoProgress& progress,
                        const StopFlag* stop);
};

}  // namespace tenebra::ao
