#include "window/scene_start.h"

#include "session/scene_summary.h"
#include "session/viewpoint.h"

namespace tenebra::viewer {
namespace {

using Wall = AnimationClock::Wall;

constexpr float flight_share = 0.1f;  // of the scene's diagonal per second

const Clip* clip_of(const session::StagedScene& staged, int clip) {
  return clip < 0 ? nullptr : &staged.scene.clips[static_cast<std::size_t>(clip)];
}

FreeCamera start_camera(const FileFrame& frame, const SceneOptions& options) {
  const session::PlacedCamera placed = session::placed_camera(frame, options);
  return {placed.eye, placed.look_at, placed.up, options.fov_deg.value_or(FreeCamera{}.fov_deg)};
}

void start_clock(ViewState& state, bool first, const ViewOptions& given, Wall now) {
  AnimationClock clock(clip_of(*state.scene, state.scene->clip), state.options.fps);
  clock.set_loop(now, first ? given.loop : state.clock.loop());
  clock.set_speed(now, first ? given.speed : state.clock.speed());
  clock.set_fixed_step(now, first ? given.fixed_step : state.clock.fixed_step());
  if (state.options.time_s) clock.seek(now, *state.options.time_s);
  if (first ? given.play : state.clock.playing()) clock.play(now);
  state.clock = clock;
}

/// The list of lights says which are on. One light beside emissive meshes, which are not in the list, or of
/// one slot alone stays a setting of the method.
void take_light(ViewState& state, int chosen) {
  const bool one_for_both = state.slots[0].render.light == state.slots[1].render.light;
  if (chosen >= 0 && (!one_for_both || state.slots[0].render.area_lights.emissive_quads)) return;
  const Scene& scene = state.scene->scene;
  const auto placed = stage::unmoved_lights(scene, state.edits, state.clip, state.options.time_s.value_or(0));
  if (chosen >= static_cast<int>(placed.size())) return;  // the renderer says so
  for (int i = 0; chosen >= 0 && i < state.light_count(); ++i) {
    state.light_edit(i).on = i == placed[static_cast<std::size_t>(chosen)].light;
  }
  for (MethodOptions& slot : state.slots) slot.render.light = -1;
}

void measure_scene(ViewState& state) {
  const auto bounds = session::summarize_scene(state.scene->scene).bounds;
  state.diagonal_m = bounds ? glm::distance(bounds->low, bounds->high) : 1.0f;
  state.centre = bounds ? 0.5f * (bounds->low + bounds->high) : glm::vec3(0.0f);
  state.half_size_m = bounds ? 0.5f * (bounds->high - bounds->low) : glm::vec3(0.5f);
  state.fly_speed = flight_share * state.diagonal_m;
}

}  // namespace

void start_scene(ViewState& state, std::shared_ptr<const session::StagedScene> staged, SceneOptions scene,
                 const ViewOptions& given, Wall now) {
  const bool first = !state.scene;
  state.scene = std::move(staged);
  state.options = std::move(scene);
  state.clip = state.scene->clip;
  state.camera = state.scene->camera;
  start_clock(state, first, given, now);
  state.camera_mode = CameraMode::scene;
  if (state.options.eye) {
    state.free = state.start = start_camera(state.scene->scene.frame, state.options);
    state.camera_mode = given.navigate;
  }
  state.pivot.reset();
  state.pivot_asked = false;
  state.edits = state.options.edits;
  state.display = state.scene->display;
  state.metered_edits = state.edits;
  state.selected_light = state.selected_node = state.selected_material = -1;
  take_light(state, first ? state.slots[0].render.light : -1);
  measure_scene(state);
}

}  // namespace tenebra::viewer
