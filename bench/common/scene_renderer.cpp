#include "bench/common/scene_renderer.h"

#include "bench/common/bench_frame.h"

namespace tenebra::bench {

void evaluate_input(const Scene& scene, int frame, int width, int height, render::FrameInput& input) {
  const auto [clip, time_s] = frame_instant(scene, frame);
  evaluate_frame(scene, clip, time_s, input.geometry);
  input.lights = evaluate_lights(scene, clip, time_s);
  input.view = evaluate_camera(scene, clip, time_s, 0, width, height);
}

Expected<SceneRenderer> SceneRenderer::create(const DrawTask& task) {
  auto raster = render::FrameRaster::create(render::RasterChoice{});
  if (!raster) return tl::unexpected(raster.error());
  return SceneRenderer(task, render::Renderer::create(std::move(*raster), task.scene));
}

render::RenderSettings SceneRenderer::settings() const {
  return {.width = task_.width, .height = task_.height, .threads = task_.threads};
}

void SceneRenderer::evaluate(int frame) {
  evaluate_input(task_.scene, frame, task_.width, task_.height, input_);
}

Expected<const render::FrameResult*> SceneRenderer::draw(const render::RenderSettings& settings) {
  if (auto drawn = renderer_.render_frame(input_, settings, result_); !drawn)
    return tl::unexpected(drawn.error());
  return &result_;
}

}  // namespace tenebra::bench
