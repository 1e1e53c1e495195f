// What a render will draw, decided before the first frame: clip, frames, camera, size and output names.
#pragma once

#include <vector>

#include "render_options.h"
#include "scene/frame_geometry.h"

namespace tenebra::viewer {

struct PlannedFrame {
  int frame = 0;
  double time_s = 0;
};

struct RenderPlan {
  Scene scene;  ///< with cameras and lights added and casters left out
  int clip = -1;
  int camera = 0;  ///< index into scene.cameras; unused with --eye
  std::vector<PlannedFrame> frames;
  RenderSettings settings;
  bool several_lights = false;  ///< masks carry the number of their light
};

/// Imports the scene and fits the options to it. Fails on what the scene does not have.
Expected<RenderPlan> plan_render(const RenderOptions& options);

/// The camera of one instant.
ViewRays view_of(const RenderPlan& plan, const RenderOptions& options, double time_s);

}  // namespace tenebra::viewer
