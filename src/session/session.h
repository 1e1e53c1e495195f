// A scene being drawn: a staged scene with the user's edits and the renderer that draws it, frame after
// frame.
#pragma once

#include <memory>

#include <tenebra/stop_flag.h>
#include "render/renderer.h"
#include "session/staged_scene.h"
#include "session/viewpoint.h"
#include "stage/edits/scene_edits.h"

namespace tenebra::session {

/// The triangles and lights of an instant, as edited. The view stays as it is.
void evaluate(const Scene& scene, const stage::SceneEdits& edits, int clip, double time_s,
              render::FrameInput& input);

/// The settings with what the edits say about sizes of lights.
render::RenderSettings with_edits(render::RenderSettings settings, const stage::SceneEdits& edits);

/// One thread at a time uses it: that which opened it, where it draws by OpenGL.
class Session {
public:
  /// Reads the file of the settings and stages it, with their edits.
  static Expected<Session> open(const settings::SceneSettings& settings, const render::RasterChoice& raster);
  /// A scene that several sessions may share.
  static Expected<Session> open(std::shared_ptr<const StagedScene> staged, const stage::SceneEdits& edits,
                                const render::RasterChoice& raster);

  const StagedScene& staged() const { return *staged_; }
  const stage::SceneEdits& edits() const { return edits_; }
  /// Takes the place of all edits before. What is drawn afterwards has the bits of a session opened with
  /// them.
  void edit(const stage::SceneEdits& edits);

  /// Evaluates the scene at an instant of its clip, or of another: what the next draws show, as `view` sees
  /// it.
  void place(double time_s, const ViewRays& view) { place(staged_->clip, time_s, view); }
  void place(int clip, double time_s, const ViewRays& view);
  /// Draws it. Fails as Renderer::render_frame; in `result` evaluate_ms and total_ms count the placing too.
  Expected<void> draw(const render::RenderSettings& settings, render::FrameResult& result,
                      const AoProgress& progress = {}, const StopFlag* stop = nullptr);

  /// What was placed last.
  const render::FrameInput& placed() const { return input_; }
  render::Renderer& renderer() { return renderer_; }
  const render::Renderer& renderer() const { return renderer_; }

private:
  Session(std::shared_ptr<const StagedScene> staged, render::Renderer renderer);

  std::shared_ptr<const StagedScene> staged_;
  stage::SceneEdits edits_;
  render::Renderer renderer_;
  render::FrameInput input_;
  double evaluate_ms_ = 0;
};

}  // namespace tenebra::session
