// What commands share about scenes: loading with warnings, and picking a clip or a camera by name or number.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "formats/import_scene.h"

namespace tenebra::viewer {

/// "warning: ..." on standard error, one line each.
void print_warnings(const std::vector<std::string>& warnings);

/// Index of the clip called `wanted`, else numbered so; without `wanted` the first. -1: the scene has none.
Expected<int> choose_clip(const Scene& scene, const std::optional<std::string>& wanted);
/// Index of the camera called `wanted`, else numbered so; without `wanted` the first. Needs a camera.
Expected<int> choose_camera(const Scene& scene, const std::optional<std::string>& wanted);

/// Time of frame `frame` of clip `clip`; 0 without a clip.
double time_of_frame(const Scene& scene, int clip, int frame, double fps);
/// Frames of clip `clip`; 1 without a clip.
int frames_of_clip(const Scene& scene, int clip, double fps);

}  // namespace tenebra::viewer
