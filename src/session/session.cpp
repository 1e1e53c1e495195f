#include "session/session.h"

#include <utility>

#include "base/stopwatch.h"

namespace tenebra::session {

void evaluate(const Scene& scene, const stage::SceneEdits& edits, int clip, double time_s,
              render::FrameInput& input) {
  evaluate_frame(scene, clip, time_s, input.geometry);
  stage::apply_node_edits(scene, edits, input.geometry);
  input.lights = stage::placed_lights(scene, edits, clip, time_s);
}

render::RenderSettings with_edits(render::RenderSettings settings, const stage::SceneEdits& edits) {
  settings.area_lights.own_size_m = stage::edited_sizes_m(edits.lights);
  settings.area_lights.own_sun_deg = stage::edited_suns_deg(edits.lights);
  return settings;
}

Session::Session(std::shared_ptr<const StagedScene> staged, render::Renderer renderer)
    : staged_(std::move(staged)), renderer_(std::move(renderer)) {}

Expected<Session> Session::open(const settings::SceneSettings& settings, const render::RasterChoice& raster) {
  auto staged = stage_scene(settings);
  if (!staged) return tl::unexpected(staged.error());
  return open(std::make_shared<const StagedScene>(std::move(*staged)), settings.edits, raster);
}

Expected<Session> Session::open(std::shared_ptr<const StagedScene> staged, const stage::SceneEdits& edits,
                                const render::RasterChoice& raster) {
  auto made = render::FrameRaster::create(raster);
  if (!made) return tl::unexpected(made.error());
  auto renderer = render::Renderer::create(std::move(*made), staged->scene);
  if (staged->environment) renderer.set_environment(*staged->environment);
  Session session(std::move(staged), std::move(renderer));
  session.edit(edits);
  return session;
}

void Session::edit(const stage::SceneEdits& edits) {
  const Scene& scene = staged_->scene;
  if (edits.lights != edits_.lights || edits.added != edits_.added)
    renderer_.set_lights(stage::lights_of(scene, edits, staged_->light_has_units));
  if (edits.materials != edits_.materials) renderer_.set_materials(stage::materials_of(scene, edits));
  edits_ = edits;
}

void Session::place(int clip, double time_s, const ViewRays& view) {
  base::Stopwatch watch;
  evaluate(staged_->scene, edits_, clip, time_s, input_);
  stage::hide_floor_from_below(staged_->added, view.eye.y, input_.geometry);
  input_.view = view;
  evaluate_ms_ = watch.lap_ms();
}

Expected<void> Session::draw(const render::RenderSettings& settings, render::FrameResult& result,
                             const AoProgress& progress, const StopFlag* stop) {
  base::Stopwatch watch;
  auto drawn = renderer_.render_frame(input_, with_edits(settings, edits_), result, progress, stop);
  if (!drawn) return drawn;
  result.timings.evaluate_ms = evaluate_ms_;
  result.timings.total_ms = evaluate_ms_ + watch.lap_ms();
  return {};
}

}  // namespace tenebra::session
