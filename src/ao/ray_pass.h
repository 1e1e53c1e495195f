// Ambient occlusion of a set of receivers by the reference: their rays through all triangles of the frame.
#pragma once

#include "ao/point_rays.h"
#include "ao/receiver_sets.h"
#include "ao/reference_rays.h"
#include "parallel/stop_flag.h"

namespace tenebra {

/// Open shares, 0..1, one a receiver; 1 where there is none. Returns the number of receivers; ends early,
/// with values missing, if `stop` is requested.
std::uint64_t cast_receivers(const ReceiverSet& set, const PointRays& rays, const ReferenceRays& reference,
                             std::vector<float>& values, const StopFlag* stop);

}  // namespace tenebra
