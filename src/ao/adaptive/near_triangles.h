// Rays of receivers through all triangles in their reach: their own body, other bodies, static and deforming
// geometry. Of each ray the first hit counts.
#pragma once

#include <map>
#include <utility>

#include "ao/casters/casters.h"
#include "ao/casters/see_through.h"

namespace tenebra::ao {

/// Patterns with the same number of rays, each shifted, so that neighbouring receivers complement one
/// another.
struct RaySets {
  static constexpr int side = 4, count = side * side;
  int rays = 0;
  std::vector<RayPattern> patterns;  ///< `count`

  const RayPattern& at(int x, int y) const {
    return patterns[static_cast<std::size_t>((y & (side - 1)) * side + (x & (side - 1)))];
  }
};
/// Those that were asked for, kept.
class KeptRaySets {
public:
  /// Other rays for each `round`.
  const RaySets& at(int rays, int round = 0);

private:
  std::map<std::pair<int, int>, RaySets> sets_;  ///< by number of rays and round
};

/// What a receiver's rays found.
struct Openness {
  float open = 1;      ///< 0..1: 1 - mean of max(0, 1 - distance / reach)
  float nearness = 1;  ///< in units of the reach: harmonic mean of the distances, at most twice the least
  float spread = 0;    ///< standard deviation of single rays
};

/// For one thread.
class NearTriangles {
public:
  /// Keeps references to casters and what is see-through until the next call.
  void begin(const Casters& casters, const SeeThroughCasters& see_through, double reach,
             const RayKernels& kernels);

  /// out[i] is receiver i's. `near`: what Casters::near() gives for a box around them, with trees built;
  /// patterns: one for each receiver, of equal numbers of rays. Adds to `rays_cast`. Once `stop` is requested
  /// the others' are left as they were.
  void look(std::span<const Receiver> receivers, std::span<const RayPattern* const> patterns,
            std::span<const int> near, Openness* out, std::uint64_t& rays_cast, const StopFlag* stop);

private:
  Openness openness(int rays) const;

  const Casters* casters_ = nullptr;
  const SeeThroughCasters* see_through_ = nullptr;
  RayKernels kernels_;
  float reach_ = 0;
  std::vector<std::uint8_t> reached_;  ///< one per caster and receiver
  std::vector<trees::RayBatch> batches_;
  std::vector<float> distances_;
};

}  // namespace tenebra::ao
