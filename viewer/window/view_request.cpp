#include "window/view_request.h"

namespace tenebra::viewer {
namespace {

MethodKey method_key(const ViewState& state, Size place) {
  MethodKey key{.active = state.compare ? 0 : state.active,
                .compare = state.compare,
                .place = place,
                .methods = {},
                .overlay = state.overlay};
  if (state.compare) {
    key.methods.assign(state.slots.begin(), state.slots.end());
  } else {
    key.methods.push_back(state.slots[static_cast<std::size_t>(state.active)]);
  }
  return key;
}

ViewKey view_key(const ViewState& state) {
  ViewKey key{.scene = state.scene.get(),
              .clip = state.clip,
              .camera = state.camera,
              .free = {},
              .edits = state.edits,
              .exposures = state.display.exposures};
  if (state.camera_mode != CameraMode::scene) key.free = state.free;
  return key;
}

}  // namespace

RequestKey request_key(const ViewState& state, Size place) {
  return {method_key(state, place), view_key(state), state.clock};
}

TradeSubject trade_subject(const ViewState& state, Size place, AnimationClock::Wall now) {
  MethodOptions method = state.slots[static_cast<std::size_t>(state.active)];
  const render::RenderSettings none;
  method.render.antialias = none.antialias;  // what is tried
  method.render.soft.error_255 = none.soft.error_255;
  method.render.ao.error_255 = none.ao.error_255;
  return {view_key(state), state.clock.time_at(now), place, std::move(method)};
}

FrameRequest view_request(const ViewState& state, Size place, const std::optional<OutputPattern>& record,
                          AnimationClock::Wall now) {
  FrameRequest request;
  request.asked = now;
  request.scene = state.scene;
  request.clip = state.clip;
  request.clock = state.clock;
  request.camera = state.camera;
  if (state.camera_mode != CameraMode::scene) request.free = state.free;
  request.edits = state.edits;
  request.slot = state.compare ? 0 : state.active;
  const SceneDisplay& display = state.display;
  request.a = render_settings(state.slots[static_cast<std::size_t>(request.slot)], place, display);
  if (state.compare) request.b = render_settings(state.slots[1], place, display);
  request.overlay = state.overlay;
  request.record = record;
  request.preview_ms = state.preview_ms;
  return request;
}

}  // namespace tenebra::viewer
