// The opponent's costs and errors on a view, over counts of rays, filters and resolutions, taken in turn with
// Tenebra's.
#pragma once

#include <map>
#include <vector>

#include "bench/ao/scenes/ao_scene_errors.h"
#include "bench/ao/scenes/ao_scene_match.h"
#include "bench/ao/scenes/ao_scene_peer.h"

namespace tenebra::bench {

class AoSceneContest {
public:
  /// Refers to both.
  AoSceneContest(const AoSceneView& view, const AoSceneTruth& truth);

  /// Measures counts of rays, the fewest first, until each of the errors is reached, or all of up to
  /// `most_rays`.
  void find_errors(std::span<const double> rms, int most_rays);
  /// Takes the times of the counts of few rays once more; those of many take too long for noise to matter.
  void run_round();
  /// What is known by now: medians.
  std::vector<CostCurve> curves() const;
  const char* tree() const { return peer_.tree(); }

private:
  struct Measured {
    double rms = 0;
    std::vector<double> finish_ms;
  };
  struct Count {
    int rays = 0;
    ao::EmbreeQuery::Rays order = ao::EmbreeQuery::coherent;
    std::vector<double> trace_ms[2];  // by step - 1
    std::vector<Measured> variants;
  };
  void measure(Count& count, int step, bool errors);

  const AoSceneTruth& truth_;
  AoScenePeer peer_;
  std::vector<double> follow_ms_;
  std::vector<Count> counts_;
};

}  // namespace tenebra::bench
