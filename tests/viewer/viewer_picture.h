// One picture of a scene as `tenebra render` draws it, in this process.
#pragma once

#include <gtest/gtest.h>

#include "options/scene_options.h"
#include "render/renderer.h"
#include "session/viewpoint.h"

namespace tenebra::testing {

inline io::Image8 picture_of(const session::StagedScene& plan, const viewer::SceneOptions& options,
                             double time_s, render::RenderSettings settings = {}) {
  auto raster = render::FrameRaster::create(render::RasterChoice{});
  EXPECT_TRUE(raster) << raster.error().message;
  render::Renderer renderer = render::Renderer::create(std::move(*raster), plan.scene);
  render::FrameInput input;
  evaluate_frame(plan.scene, plan.clip, time_s, input.geometry);
  input.lights = evaluate_lights(plan.scene, plan.clip, time_s);
  input.view = session::rays_of(plan, session::viewpoint_of(plan, options), time_s, plan.size);
  settings.width = plan.size.width;
  settings.height = plan.size.height;
  render::FrameResult result;
  const auto drawn = renderer.render_frame(input, settings, result);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return std::move(result.image);
}

}  // namespace tenebra::testing
