// Cosine-weighted rays and the occlusion that they add up to: the measurements' own code, so that contestants
// are compared on the same rays. Shares no code with src/ao but the batch of sixteen.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "trees/ray_batch.h"

namespace tenebra::bench {

/// Where ambient light arrives.
struct Receiver {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0, 1, 0};  ///< unit
};

/// A direction about +z for each point of the unit square, as dense as the cosine: Shirley and Chiu's
/// concentric map.
glm::vec3 cosine_direction(double x, double y);

/// Directions of a Fibonacci lattice through Shirley's concentric map, turned about each point's normal by a
/// hash of `seed` and the point's number. Sixteen rays in a row are neighbours.
class CosineRays {
public:
  /// `count`: a multiple of 16.
  CosineRays(int count, std::uint64_t seed);
  int count() const { return static_cast<int>(directions_.size()); }
  /// Fills count() / 16 batches with the rays of receiver number `index`.
  void batches(const Receiver& receiver, std::size_t index, std::span<trees::RayBatch> out) const;

private:
  std::uint64_t seed_;
  std::vector<glm::vec3> directions_;  // around +z
};

/// Traces any number of rays: distances[i] becomes the t of ray i's nearest hit if that is less, else it
/// stays.
using Tracer = std::function<void(std::span<const trees::RayBatch>, float* distances)>;

/// 1 closed .. 0 open, one per receiver, with linear fall-off to nothing at `distance`. On all threads; the
/// same bits for any number.
std::vector<float> occlusion(std::span<const Receiver> receivers, const CosineRays& rays, float distance,
                             const Tracer& tracer);

/// Rays of all receivers that may meet a sphere, filled up to whole batches in order.
std::vector<trees::RayBatch> batches_towards(std::span<const Receiver> receivers, const CosineRays& rays,
                                             glm::dvec3 centre, double radius);

/// Root of the mean square of the difference, in 1/255.
double rms_255(std::span<const float> a, std::span<const float> b);

}  // namespace tenebra::bench
