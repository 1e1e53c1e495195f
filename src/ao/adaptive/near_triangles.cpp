#include "ao/adaptive/near_triangles.h"

#include <algorithm>
#include <cmath>

#include "ao/cast/sphere_maps.h"

namespace tenebra::ao {

namespace {

RaySets make_ray_sets(int rays, int round) {
  // Shifts by the two-dimensional golden ratio: any run of them is spread evenly over the square. Neighbours
  // in the picture take numbers far apart.
  constexpr double gold_x = 0.7548776662466927, gold_y = 0.5698402909980532;
  constexpr int order[RaySets::count] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  RaySets sets{rays, {}};
  for (const int number : order) {
    const int shift = number + RaySets::count * round;
    sets.patterns.push_back(make_ray_pattern(rays, {shift * gold_x, shift * gold_y}));
  }
  return sets;
}

}  // namespace

const RaySets& KeptRaySets::at(int rays, int round) {
  const auto found = sets_.find({rays, round});
  if (found != sets_.end()) return found->second;
  return sets_.emplace(std::pair(rays, round), make_ray_sets(rays, round)).first->second;
}

void NearTriangles::begin(const Casters& casters, const SeeThroughCasters& see_through, double reach,
                          const RayKernels& kernels) {
  casters_ = &casters;
  see_through_ = &see_through;
  kernels_ = kernels;
  reach_ = static_cast<float>(reach);
}

void NearTriangles::look(std::span<const Receiver> receivers, std::span<const RayPattern* const> patterns,
                         std::span<const int> near, Openness* out, std::uint64_t& rays_cast,
                         const StopFlag* stop) {
  const std::size_t count = receivers.size();
  reached_.resize(near.size() * count);
  for (std::size_t n = 0; n < near.size(); ++n)
    casters_->reaches(near[n], receivers, Casters::Itself::counts, reached_.data() + n * count);
  for (std::size_t i = 0; i < count && !stop_requested(stop); ++i) {
    const Receiver& receiver = receivers[i];
    const RayPattern& pattern = *patterns[i];
    batches_.resize(pattern.batches.size());
    distances_.assign(pattern.batches.size() * trees::batch_size, reach_);
    const glm::dvec3 origin = casters_->start_of(receiver);
    const Frame frame = frame_around(receiver.normal);
    kernels_.fan.spread(pattern, {frame.x, frame.y, receiver.normal}, receiver.face, glm::vec3(origin),
                        batches_.data());
    for (std::size_t n = 0; n < near.size(); ++n) {
      if (reached_[n * count + i] != 0)
        casters_->meet(near[n], receiver, origin, batches_, distances_.data(), rays_cast);
    }
    out[i] = openness(pattern.rays);
    if (!see_through_->empty())
      out[i].open *=
          see_through_->left(origin, batches_, pattern.rays, reach_, kernels_, distances_, rays_cast);
  }
}

Openness NearTriangles::openness(int rays) const {
  constexpr float least = 1e-3f;  // of the reach: nearer is near enough
  float nearest = 1, inverse = 0, sum = 0, squares = 0;
  for (int i = 0; i < rays; ++i) {
    const float distance = distances_[static_cast<std::size_t>(i)] / reach_, hidden = 1 - distance;
    nearest = std::min(nearest, distance);
    inverse += 1 / std::max(distance, least);
    sum += hidden, squares += hidden * hidden;
  }
  const auto count = static_cast<float>(rays);
  const float mean = std::clamp(sum / count, 0.0f, 1.0f);
  return {1 - mean, std::min(count / inverse, 2 * nearest),
          std::sqrt(std::max(0.0f, squares / count - mean * mean))};
}

}  // namespace tenebra::ao
