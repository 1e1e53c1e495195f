// The program's renderer on frames of one scene: what `tenebra render` does for a frame, but for files.
#pragma once

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "render/renderer.h"

namespace tenebra::bench {

/// What is drawn of a scene: its first clip, its first camera.
struct DrawTask {
  const Scene& scene;  ///< as the program prepares it; must outlive the renderer
  int width = 0;
  int height = 0;
  int threads = 0;  ///< 0: all
};

/// Frame `frame` of the first clip, from the first camera. Buffers of `input` keep their capacity.
void evaluate_input(const Scene& scene, int frame, int width, int height, render::FrameInput& input);

class SceneRenderer {
public:
  /// With the rasteriser that `tenebra render` chooses.
  static Expected<SceneRenderer> create(const DrawTask& task);

  const DrawTask& task() const { return task_; }
  /// Of the task's size and threads, else the library's: hard shadows, one sample per pixel.
  render::RenderSettings settings() const;

  void evaluate(int frame);
  /// Of the frame evaluated last.
  render::FrameInput& input() { return input_; }
  /// The frame evaluated last; valid until the next call.
  Expected<const render::FrameResult*> draw(const render::RenderSettings& settings);
  const render::FrameResult& result() const { return result_; }

private:
  SceneRenderer(const DrawTask& task, render::Renderer renderer)
      : task_(task), renderer_(std::move(renderer)) {}

  DrawTask task_;
  render::Renderer renderer_;
  render::FrameInput input_;
  render::FrameResult result_;
};

}  // namespace tenebra::bench
