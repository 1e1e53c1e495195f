// Whole frames of one scene at one size: Tenebra's renderer as the program runs it, and the opponent, frame
// by frame in turn.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "bench/frame/embree_renderer.h"

namespace tenebra::bench {

struct FrameContest {
  std::string name;         ///< "city 150"
  std::vector<int> frames;  ///< consecutive; the first is drawn but not measured
  int rounds = 3;
  double most_differing = 0.01;  ///< share of the pixels of a frame: beyond it the pictures are not the same
};

/// Medians in milliseconds over frames and rounds.
struct TenebraFrameTimes {
  double evaluate = 0, raster = 0, points = 0, shadows = 0, shade = 0, total = 0;
};
struct FrameContestResult {
  TenebraFrameTimes ours;
  EmbreeFrameTimes theirs;
  std::string embree_by;  ///< "2-level refit, 4x4 to"
  double differing = 0;   ///< largest share of pixels that differ by more than 16/255 in a channel
  std::size_t lights = 0;
  double ratio() const { return ours.total / theirs.total; }
  /// Without the shading, which is the same code on both sides.
  double unshaded_ratio() const { return (ours.total - ours.shade) / (theirs.total - theirs.shade); }
};

/// Fails where Tenebra cannot draw, and where the pictures are not the same.
Expected<FrameContestResult> run_frame_contest(const FrameTask& task, const FrameContest& contest);

}  // namespace tenebra::bench
