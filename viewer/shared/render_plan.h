// What a render will draw, decided before the first frame: scene, frames and settings.
#pragma once

#include <memory>
#include <vector>

#include "options/render_options.h"
#include "session/session.h"

namespace tenebra::viewer {

struct PlannedFrame {
  int frame = 0;
  double time_s = 0;
};

struct RenderPlan {
  std::shared_ptr<const session::StagedScene> staged;
  session::Viewpoint viewpoint;
  std::vector<PlannedFrame> frames;  ///< none: the chunk is empty
  render::RenderSettings settings;
  bool of_several_frames = false;  ///< before they were cut into chunks
  bool several_lights = false;     ///< masks carry the number of their light
  int lights = 1;                  ///< that masks are made of, as far as known: emissive meshes come on top

  /// What its pictures show at one instant.
  ViewRays rays(double time_s) const { return session::rays_of(*staged, viewpoint, time_s, staged->size); }
};

/// Imports the scene and fits the options to it. Fails on what the scene does not have.
Expected<RenderPlan> plan_render(const RenderOptions& options);

/// The scene of a plan, ready to be drawn.
Expected<session::Session> open_session(const RenderPlan& plan, const RenderOptions& options);

/// Fails if the scene with its edits lacks light `light` (-1: all) at `time_s`; else the number of its
/// lights.
Expected<int> check_light(const session::StagedScene& staged, const stage::SceneEdits& edits, int light,
                          double time_s);

}  // namespace tenebra::viewer
