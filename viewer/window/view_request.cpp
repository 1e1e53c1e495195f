#include "window/view_request.h"

#include <fmt/format.h>

#include "options/edit_texts.h"
#include "options/method_arguments.h"

namespace tenebra::viewer {
namespace {

std::string method_key(const ViewState& state, Size place) {
  std::string key;
  if (state.compare) {
    key = fmt::format("true 0 {}x{}", place.width, place.height);
    for (const MethodOptions& slot : state.slots) key += "|" + method_arguments(slot);
  } else {
    key = fmt::format("{} {}x{}|{}", state.active, place.width, place.height,
                      method_arguments(state.slots[static_cast<std::size_t>(state.active)]));
  }
  return key + fmt::format("|{}", static_cast<int>(state.overlay));
}

std::string view_key(const ViewState& state) {
  std::string key = fmt::format("{} {} {} {}", fmt::ptr(state.scene.get()), state.clip, state.camera,
                                state.camera_mode == CameraMode::scene ? "" : camera_arguments(state.free));
  for (const EditOption& edit : edit_options(state.edits))
    key += fmt::format("|{} {}", edit.name, edit.value);
  return key;
}

}  // namespace

RequestKey request_key(const ViewState& state, Size place) {
  return {method_key(state, place), view_key(state), state.clock};
}

std::string trade_subject(const ViewState& state, Size place, AnimationClock::Wall now) {
  MethodOptions method = state.slots[static_cast<std::size_t>(state.active)];
  const render::RenderSettings none;
  method.render.antialias = none.antialias;  // what is tried
  method.render.soft.error_255 = none.soft.error_255;
  method.render.ao.error_255 = none.ao.error_255;
  return fmt::format("{}|{}|{}x{}|{}", view_key(state), state.clock.time_at(now), place.width, place.height,
                     method_arguments(method));
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
  const SceneDisplay& display = state.scene->display;
  request.a = method_settings(state.slots[static_cast<std::size_t>(request.slot)], place, display);
  if (state.compare) request.b = method_settings(state.slots[1], place, display);
  request.overlay = state.overlay;
  request.record = record;
  request.preview_ms = state.preview_ms;
  return request;
}

}  // namespace tenebra::viewer
