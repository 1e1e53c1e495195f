#include "ao/adaptive/pixel_looks.h"

#include <algorithm>
#include <numeric>

#include "base/sort_unique.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

PixelLooks::PixelLooks(const AdaptiveScene& scene, const PixelSurfaces& surfaces, const StopFlag* stop,
                       LookRoom& room)
    : scene_(scene), tiles_(surfaces.width, surfaces.height), stop_(stop), room_(room) {
  const auto count = static_cast<std::size_t>(tiles_.count());
  if (room.near.size() < count) room.near.resize(count);
  room.rays_cast.assign(count, 0);
  room.looks.assign(count, 0);
  room.workers.resize(std::max(room.workers.size(), static_cast<std::size_t>(thread_count())));
  for (LookRoom::Worker& worker : room.workers)
    worker.triangles.begin(scene.casters, scene.see_through, scene.reach, scene.kernels);
  find_near(surfaces);
}

/// What moves is in one tree that is made for each frame or, where it has too many triangles for that, in a
/// tree of each object in its own space, which is kept.
void PixelLooks::find_near(const PixelSurfaces& surfaces) {
  const auto lists = std::span(room_.near).first(static_cast<std::size_t>(tiles_.count()));
  parallel::parallel_tasks(tiles_.count(), [&](int tile) {
    std::vector<int>& near = lists[static_cast<std::size_t>(tile)];
    near.clear();
    math::Box<double> box;
    tiles_.each(tile, 1, [&](int x, int y) {
      const std::size_t i = surfaces.index(x, y);
      if (surfaces.pixels[i].there()) box.add(scene_.frame.points.positions[i]);
    });
    if (!box.empty()) scene_.casters.near(box, near);
  });
  std::vector<int>& all = room_.all;
  all.clear();
  for (const std::vector<int>& near : lists) all.insert(all.end(), near.begin(), near.end());
  base::sort_unique(all);
  Casters& casters = scene_.casters;
  if (!casters.gather(all)) return casters.build(all);
  const int standing = casters.standing();
  for (std::vector<int>& near : lists) {
    const bool stands = std::find(near.begin(), near.end(), standing) != near.end();
    const bool moves = near.size() > (stands ? 1u : 0u);
    near.clear();
    if (stands) near.push_back(standing);
    if (moves) near.push_back(casters.gathered());
  }
  if (std::binary_search(all.begin(), all.end(), standing)) casters.build({&standing, 1});
}

void PixelLooks::make_receivers(int step, const RaySets& sets, LookRoom::Worker& worker) const {
  const AoFrame& frame = scene_.frame;
  worker.receivers.clear();
  worker.patterns.clear();
  ReceiverMaker maker(frame.geometry, frame.objects);
  for (const std::uint32_t i : worker.pixels) {
    Receiver& receiver = worker.receivers.emplace_back();
    receiver.index = i;
    if (!maker.make(frame.points.triangles[i], frame.points.positions[i], frame.normals[i], receiver)) {
      worker.receivers.pop_back();
      continue;
    }
    const int x = static_cast<int>(i) % tiles_.width, y = static_cast<int>(i) / tiles_.width;
    worker.patterns.push_back(&sets.at(x / step, y / step));
  }
}

void PixelLooks::look(int step, const RaySets& sets, Choice choose, Take take) {
  parallel::parallel_tasks(tiles_.count(), [&](int tile) {
    if (stop_requested(stop_)) return;
    const auto at = static_cast<std::size_t>(tile);
    LookRoom::Worker& worker = room_.workers[static_cast<std::size_t>(parallel::thread_index())];
    worker.pixels.clear();
    choose(tile, worker.pixels);
    make_receivers(step, sets, worker);
    worker.found.resize(worker.receivers.size());
    worker.triangles.look(worker.receivers, worker.patterns, room_.near[at], worker.found.data(),
                          room_.rays_cast[at], stop_);
    if (stop_requested(stop_)) return;
    for (std::size_t k = 0; k < worker.receivers.size(); ++k)
      take(static_cast<std::uint32_t>(worker.receivers[k].index), worker.found[k]);
    room_.looks[at] += worker.receivers.size();
  });
}

std::uint64_t PixelLooks::rays_cast() const {
  return std::accumulate(room_.rays_cast.begin(), room_.rays_cast.end(), std::uint64_t{0});
}

std::uint64_t PixelLooks::looks() const {
  return std::accumulate(room_.looks.begin(), room_.looks.end(), std::uint64_t{0});
}

}  // namespace tenebra::ao
