// From triangle ids to the masks of all lights of a frame: Tenebra, and Embree at the best of all its trees
// and packets.
#pragma once

#include <string>
#include <vector>

#include "bench/common/bench_report.h"
#include "bench/hard/hard_views.h"

namespace tenebra::bench {

struct WholeTask {
  const HardView& view;
  std::vector<ShadowLight> lights;
  int threads = 1;
  int rounds = 5;
  SimdLevel simd = SimdLevel::automatic;  ///< of both
};

/// One side of a contest: medians in milliseconds.
struct WholeTimes {
  double ours = 0;
  double embree = 0;
  double embree_build = 0;  ///< of which building or refitting
  std::string embree_by;    ///< "refit, 4x4 to"
  double ratio() const { return ours / embree; }
};
struct WholeResult {
  WholeTimes moved;           ///< triangles moved since the frame before: building or refitting is counted
  WholeTimes still;           ///< nothing moved
  double tiles = 0;           ///< of ours: from ids to tiles of points
  std::size_t differing = 0;  ///< samples of all lights where the masks differ
  std::size_t lit = 0;        ///< of ours
  std::size_t samples = 0;    ///< visible points times lights
};

WholeResult run_whole_contest(const WholeTask& task);

}  // namespace tenebra::bench
