#include "ao/shade/ray_pass.h"

#include <algorithm>
#include <numeric>

#include "parallel/parallel.h"

namespace tenebra::ao {

std::uint64_t cast_receivers(const ReceiverSet& set, const PointRays& rays, const ReferenceRays& reference,
                             std::vector<float>& values, RayRoom& room, const StopFlag* stop) {
  values.assign(set.values(), 1.0f);
  room.workers.resize(std::max(room.workers.size(), static_cast<std::size_t>(thread_count())));
  std::vector<std::uint64_t>& points = room.points;
  points.assign(static_cast<std::size_t>(set.groups()), 0);
  parallel::parallel_tasks(set.groups(), [&](int group) {
    if (stop_requested(stop)) return;
    RayRoom::Worker& own = room.workers[static_cast<std::size_t>(parallel::thread_index())];
    set.receivers(group, own.receivers);
    points[static_cast<std::size_t>(group)] = own.receivers.size();
    own.batches.resize(rays.batches());
    for (const Receiver& receiver : own.receivers) {
      if (stop_requested(stop)) return;
      rays.spread(receiver, own.batches.data());
      own.distances.assign(rays.batches() * trees::batch_size, rays.reach());
      for (std::size_t b = 0; b < own.batches.size(); ++b)
        reference.nearest_hits(own.batches[b], own.distances.data() + b * trees::batch_size);
      values[receiver.index] = 1 - rays.hidden(own.distances.data());
    }
  });
  return std::accumulate(points.begin(), points.end(), std::uint64_t{0});
}

}  // namespace tenebra::ao
