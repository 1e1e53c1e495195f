// Pictures of a view's ambient occlusion and of its errors, to look at.
#pragma once

#include <span>
#include <string>

#include <tenebra/expected.h>
#include "bench/ao/scenes/ao_scene_errors.h"
#include "io/image.h"

namespace tenebra::bench {

/// Grey, 255 open; black where there is no value.
io::Image8 openness_picture(std::span<const float> values, int width, int height);
/// The truth; with a step each pixel of the lattice as a square.
io::Image8 truth_picture(const AoSceneTruth& truth, int width, int height);
/// White where there is no error, red where too dark, blue where too bright, full at 32/255; grey where the
/// truth is not known.
io::Image8 error_picture(std::span<const float> values, const AoSceneTruth& truth, int width, int height);

/// The three in `folder`, made if it is missing: STEM_truth.png, STEM_value.png, STEM_error.png.
Expected<void> write_ao_pictures(const std::filesystem::path& folder, const std::string& stem,
                                 std::span<const float> values, const AoSceneTruth& truth, int width,
                                 int height);

}  // namespace tenebra::bench
