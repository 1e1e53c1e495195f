// How far answers are from the truth of a view.
#pragma once

#include <span>
#include <vector>

#include "bench/ao/scenes/ao_scene_truth.h"

namespace tenebra::bench {

/// In 1/255, over the pixels of the truth.
struct AoSceneErrors {
  double rms = 0;
  double p99 = 0;  ///< what 99 of 100 pixels do not exceed
  double worst = 0;
};

/// |value - truth| of each of the truth's pixels, in 1/255; 255 for what is no number within 0 .. 1.
/// `values`: one for each pixel of the picture.
std::vector<double> pixel_errors(std::span<const float> values, const AoSceneTruth& truth);
AoSceneErrors scene_errors(std::span<const float> values, const AoSceneTruth& truth);

/// A pixel that is far off.
struct WorstPixel {
  std::size_t pixel = 0;
  float value = 0, truth = 0;
};
/// Up to `count`, the worst first, none within `apart` pixels of another.
std::vector<WorstPixel> worst_pixels(std::span<const float> values, const AoSceneTruth& truth, int width,
                                     int count, int apart);

}  // namespace tenebra::bench
