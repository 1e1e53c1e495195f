// What the contestants of `tenebra-bench soft` are measured on: frames of BART and of the bundled court, each
// with one area light.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/area_light.h>
#include "bench/common/bench_command.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

struct SoftView {
  std::string name;       ///< "robots 100"
  bool counted = false;   ///< enters the summary: one of the four views that the goals are stated for
  bool sun_only = false;  ///< another view than the contests': for the sun alone
  bool large = false;     ///< for a light of half the diagonal alone
  BenchFrame frame;
  AreaLight light;
  std::optional<AreaLight> sun;  ///< 0.53 degrees wide; of scenes under the sky
};

struct ViewChoice {
  int width = 1280;
  int height = 720;
  bool more_frames = false;       ///< a second frame of each BART scene beside the four
  bool large_lights = false;      ///< views of a light of half the diagonal, too, of 320x180 pixels at most
  std::vector<std::string> only;  ///< names of scenes ("robots"); empty: all
};

std::vector<std::string> scene_names();

/// Loads one view after another and calls `body`, so that one scene is in memory at a time. Scenes that are
/// not there are named on standard error and in `skipped`. Fails where a scene that is there cannot be read.
Expected<void> for_each_view(const BenchOptions& options, const ViewChoice& choice,
                             std::vector<std::string>& skipped,
                             const std::function<Expected<void>(const SoftView&)>& body);

/// The scene's first light as a square of `side_percent` of the scene's diagonal that faces the centre of the
/// scene's box; `shift_m` from its place.
Expected<AreaLight> square_light(const BenchFrame& frame, double side_percent, glm::vec3 shift_m = {});

}  // namespace tenebra::bench
