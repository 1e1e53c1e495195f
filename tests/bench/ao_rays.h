// Cosine-weighted rays and what occlusion they add up to: the measurements' own, so that contestants are
// compared on the same rays. Shares no code with src/ao but the batch of sixteen.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "ao/ray_batch.h"

namespace tenebra::bench {

/// Where ambient light arrives.
struct Receiver {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0, 1, 0};  ///< unit
};

/// across x down strata of Shirley's concentric map, each point's pattern shifted within the strata (one of
/// 64 shifts) and turned about its normal by a hash of `seed` and its number. Sixteen rays in a row are
/// neighbours.
class CosineRays {
public:
  /// across and down are multiples of 4, or one is 1 and the other a multiple of 16.
  CosineRays(int across, int down, std::uint64_t seed);
  int count() const { return count_; }
  /// Fills count() / 16 batches with the rays of receiver number `index`.
  void batches(const Receiver& receiver, std::size_t index, std::span<RayBatch> out) const;

private:
  int count_;
  std::uint64_t seed_;
  std::vector<glm::vec3> directions_;  // around +z; count_ a shift
};

/// Sixteen rays: distance[i] = t of the nearest hit before distance[i], else left as it is.
using Tracer = std::function<void(const RayBatch&, float* distance)>;

/// 1 closed .. 0 open, one a receiver, with linear fall-off to nothing at `distance`. On all threads; the
/// same bits for any number.
std::vector<float> occlusion(std::span<const Receiver> receivers, const CosineRays& rays, float distance,
                             const Tracer& tracer);

/// Rays of all receivers that may meet a sphere, filled up to whole batches in order.
std::vector<RayBatch> batches_towards(std::span<const Receiver> receivers, const CosineRays& rays,
                                      glm::dvec3 centre, double radius);

/// Milliseconds that `tracer` takes for all batches, on the threads that the caller allows.
double trace_ms(std::span<const RayBatch> batches, const Tracer& tracer);

/// Root of the mean square of the difference, in 1/255.
double rms_255(std::span<const float> a, std::span<const float> b);

}  // namespace tenebra::bench
