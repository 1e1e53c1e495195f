// What the contestants of `tenebra-bench hard` are measured on: frames of BART and of the bundled scenes,
// each with its first light.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tenebra/hard_shadows.h>
#include "bench/common/bench_command.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

struct HardView {
  std::string name;      ///< "robots 100"
  bool counted = false;  ///< a frame of BART: enters the geometric means
  BenchFrame frame;
  FrameGeometry before;  ///< the geometry one frame earlier: what an animation's tracer has met last
  ShadowLight light;
};

/// Frames of one scene, for measuring.
struct HardFrames {
  std::string scene;
  std::vector<int> frames;
};
/// The frames that the goals are stated for; with `quick` fewer bundled ones.
std::vector<HardFrames> hard_frames(bool quick);

struct PictureSize {
  int width = 1024;
  int height = 1024;
};

/// Loads one scene after another, evaluates one frame after another and calls `body`. Scenes that are not
/// there are named on standard error and in `skipped`. Fails where one that is there cannot be read.
Expected<void> for_each_view(const BenchOptions& options, const std::vector<HardFrames>& chosen,
                             PictureSize size, std::vector<std::string>& skipped,
                             const std::function<Expected<void>(const Scene&, const HardView&)>& body);

/// Frame `number` of `scene`, its first light.
void evaluate_hard_view(const Scene& scene, int number, PictureSize size, HardView& view);

/// Each triangle by the middles of its edges in four, in place; triangle i becomes 4 i ... 4 i + 3. Corners
/// stay where they are; middles are rounded to float.
void subdivide(FrameGeometry& g);
/// The view with other triangles: what its pixels see is found anew.
void see_anew(HardView& view, PictureSize size);

}  // namespace tenebra::bench
