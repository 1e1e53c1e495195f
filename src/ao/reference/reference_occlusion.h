// Ambient occlusion of a set of receivers by the reference: their rays through all triangles of the frame.
#pragma once

#include <optional>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/stop_flag.h>
#include "ao/receivers/point_rays.h"
#include "ao/receivers/receiver_sets.h"
#include "ao/reference/reference_rays.h"

namespace tenebra::ao {

/// Lists are kept from frame to frame.
class ReferenceOcclusion {
public:
  /// The instant of `geometry`. `stands`: what rays meet is the same from frame to frame, and its tree is
  /// kept. Fails as ReferenceRays::create.
  Expected<void> begin_frame(const FrameGeometry& geometry, bool stands, const StopFlag* stop);
  /// Openness, 0..1, one per receiver; 1 where there is none. Returns the number of receivers; ends early,
  /// with values missing, if `stop` is requested.
  std::uint64_t compute(const ReceiverSet& set, const PointRays& rays, std::vector<float>& values,
                        const StopFlag* stop);
  /// Forgets the tree.
  void drop() { reference_.reset(); }

private:
  struct Worker {
    std::vector<Receiver> receivers;
    std::vector<trees::RayBatch> batches;
    std::vector<float> distances;
  };
  std::optional<ReferenceRays> reference_;
  std::vector<Worker> workers_;        ///< one for each thread
  std::vector<std::uint64_t> points_;  ///< of each group
};

}  // namespace tenebra::ao
