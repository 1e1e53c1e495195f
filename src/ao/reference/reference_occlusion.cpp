#include "ao/reference/reference_occlusion.h"

#include <algorithm>
#include <numeric>

#include "parallel/parallel.h"

namespace tenebra::ao {

Expected<void> ReferenceOcclusion::begin_frame(const FrameGeometry& geometry, bool stands,
                                               const StopFlag* stop) {
  if (reference_ && stands) return {};
  reference_.reset();
  auto made = ReferenceRays::create(triangle_view(geometry), stop);
  if (!made) return tl::unexpected(made.error());
  reference_ = std::move(*made);
  return {};
}

std::uint64_t ReferenceOcclusion::compute(const ReceiverSet& set, const PointRays& rays,
                                          std::vector<float>& values, const StopFlag* stop) {
  values.assign(set.values(), 1.0f);
  workers_.resize(std::max(workers_.size(), static_cast<std::size_t>(thread_count())));
  points_.assign(static_cast<std::size_t>(set.groups()), 0);
  parallel::parallel_tasks(set.groups(), [&](int group) {
    if (stop_requested(stop)) return;
    Worker& own = workers_[static_cast<std::size_t>(parallel::thread_index())];
    set.receivers(group, own.receivers);
    points_[static_cast<std::size_t>(group)] = own.receivers.size();
    own.batches.resize(rays.batches());
    for (const Receiver& receiver : own.receivers) {
      if (stop_requested(stop)) return;
      rays.spread(receiver, own.batches.data());
      own.distances.assign(rays.batches() * trees::batch_size, rays.reach());
      for (std::size_t b = 0; b < own.batches.size(); ++b)
        reference_->nearest_hits(own.batches[b], own.distances.data() + b * trees::batch_size);
      values[receiver.index] = 1 - rays.hidden(own.distances.data());
    }
  });
  return std::accumulate(points_.begin(), points_.end(), std::uint64_t{0});
}

}  // namespace tenebra::ao
