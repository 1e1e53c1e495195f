// What a render will draw, decided before the first frame: scene, frames and settings.
#pragma once

#include <vector>

#include "options/render_options.h"
#include "shared/scene_plan.h"

namespace tenebra::viewer {

struct PlannedFrame {
  int frame = 0;
  double time_s = 0;
};

struct RenderPlan : ScenePlan {
  std::vector<PlannedFrame> frames;  ///< none: the chunk is empty
  render::RenderSettings settings;
  bool of_several_frames = false;  ///< before they were cut into chunks
  bool several_lights = false;     ///< masks carry the number of their light
  int lights = 1;                  ///< that masks are made of, as far as known: emissive meshes come on top
  std::vector<std::filesystem::path> inputs;  ///< the files that its pictures follow from
};

/// Imports the scene and fits the options to it. Fails on what the scene does not have.
Expected<RenderPlan> plan_render(const RenderOptions& options);

}  // namespace tenebra::viewer
