// Ambient occlusion of a set of receivers by the reference: their rays through all triangles of the frame.
#pragma once

#include <tenebra/stop_flag.h>
#include "ao/cast/reference_rays.h"
#include "ao/shade/point_rays.h"
#include "ao/shade/receiver_sets.h"

namespace tenebra::ao {

/// Lists that are kept from frame to frame.
struct RayRoom {
  struct Worker {
    std::vector<Receiver> receivers;
    std::vector<trees::RayBatch> batches;
    std::vector<float> distances;
  };
  std::vector<Worker> workers;        ///< one for each thread
  std::vector<std::uint64_t> points;  ///< of each group
};

/// Openness, 0..1, one per receiver; 1 where there is none. Returns the number of receivers; ends early,
/// with values missing, if `stop` is requested.
std::uint64_t cast_receivers(const ReceiverSet& set, const PointRays& rays, const ReferenceRays& reference,
                             std::vector<float>& values, RayRoom& room, const StopFlag* stop);

}  // namespace tenebra::ao
