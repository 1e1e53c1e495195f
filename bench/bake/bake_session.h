// One run of `tenebra-bench bake`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>

#include "bench/common/bench_session.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct BakeHeadline {
  std::optional<double> exact_over_rays, within_over_rays, exact_over_rays_penumbra, rays, worst_255;
};

struct BakeSession : BenchSession {
  using BenchSession::BenchSession;

  BakeHeadline headline;
};

// The parts.
Expected<void> measure_bake_map(BakeSession& session);  ///< a lightmap's light, beside stratified rays

}  // namespace tenebra::bench
