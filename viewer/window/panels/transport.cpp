// The bar under the picture: play, steps, the scrubber, speed.
#include <fmt/core.h>
#include <cmath>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

AnimationClock::Wall now() {
  return std::chrono::steady_clock::now();
}

enum class Sign { play, pause, back, forward, record, stop };

/// A button with a drawn sign: fonts do not all have them.
bool sign_button(Ui& ui, const char* name, Sign sign) {
  const float height = ImGui::GetFrameHeight();
  const bool pressed = ImGui::Button(fmt::format("##{}", name).c_str(), {height * 1.35f, height});
  ui.mark(name);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float x = (low.x + high.x) / 2, y = (low.y + high.y) / 2, r = height * 0.23f;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (sign == Sign::play)
    list.AddTriangleFilled({x - r * 0.8f, y - r}, {x + r, y}, {x - r * 0.8f, y + r}, palette::text);
  if (sign == Sign::pause) {
    list.AddRectFilled({x - r, y - r}, {x - r * 0.3f, y + r}, palette::text);
    list.AddRectFilled({x + r * 0.3f, y - r}, {x + r, y + r}, palette::text);
  }
  if (sign == Sign::record) list.AddCircleFilled({x, y}, r, IM_COL32(236, 92, 84, 255));
  if (sign == Sign::stop) list.AddRectFilled({x - r, y - r}, {x + r, y + r}, IM_COL32(236, 92, 84, 255));
  if (sign == Sign::back || sign == Sign::forward) {
    const float d = sign == Sign::back ? -1.0f : 1.0f;
    if (d > 0) list.AddTriangleFilled({x - r, y - r}, {x + r * 0.4f, y}, {x - r, y + r}, palette::text);
    if (d < 0) list.AddTriangleFilled({x + r, y - r}, {x + r, y + r}, {x - r * 0.4f, y}, palette::text);
    list.AddRectFilled({x + d * r * 0.5f, y - r}, {x + d * r * 0.9f, y + r}, palette::text);
  }
  return pressed;
}

void draw_buttons(Ui& ui) {
  ViewState& state = ui.state;
  const float gap = ui.px(3);
  if (sign_button(ui, "play", state.clock.playing() ? Sign::pause : Sign::play)) toggle_playing(state);
  tooltip("Play or pause (Space)");
  ImGui::SameLine(0, gap);
  if (sign_button(ui, "step back", Sign::back)) state.clock.step(now(), -1);
  tooltip("One frame back (Left)");
  ImGui::SameLine(0, gap);
  if (sign_button(ui, "step forward", Sign::forward)) state.clock.step(now(), 1);
  tooltip("One frame forward (Right)");
  ImGui::SameLine(0, gap);
  if (sign_button(ui, "record", state.recording ? Sign::stop : Sign::record)) ui.actions.record = true;
  tooltip("Writes every frame of the animation as a picture, to a new folder here; click again to stop (O)");
}

void draw_speed(Ui& ui) {
  AnimationClock& clock = ui.state.clock;
  ImGui::SetNextItemWidth(ui.px(150));
  float speed = static_cast<float>(clock.speed());
  const char* format =
      clock.fixed_step() ? (clock.speed() < 0 ? "fixed steps back" : "fixed steps") : "speed %.2fx";
  if (ImGui::SliderFloat("##speed", &speed, -static_cast<float>(fastest_speed),
                         static_cast<float>(fastest_speed), format)) {
    clock.set_speed(now(), std::round(speed * 20) / 20.0);
  }
  ui.mark("speed");
  tooltip("Seconds of the animation per second of yours; below zero it runs backwards. Ctrl-click to type.");
  ImGui::SameLine();
  bool loop = clock.loop();
  if (ImGui::Checkbox("loop", &loop)) clock.set_loop(now(), loop);
  ui.mark("loop");
  ImGui::SameLine();
  bool fixed_step = clock.fixed_step();
  if (ImGui::Checkbox("fixed step", &fixed_step)) clock.set_fixed_step(now(), fixed_step);
  ui.mark("fixed step");
  tooltip("Shows every frame, however long it takes, for measuring. Otherwise time follows the clock.");
}

void draw_scrubber(Ui& ui) {
  AnimationClock& clock = ui.state.clock;
  const double begin_s = clock.start_s(), end_s = clock.end_s();
  // While the animation plays the scrubber shows the picture's moment; while it is dragged, its own.
  const auto at = now();
  double time_s = clock.time_at(at);
  if (clock.runs() && ui.picture) time_s = ui.picture->a.record.time_s;
  const std::string format =
      fmt::format("{:.3f} s   frame {} of 0..{}", time_s, clock.frame_of(time_s), clock.frames() - 1);
  ImGui::SetNextItemWidth(-1);
  const bool changed =
      ImGui::SliderScalar("##time", ImGuiDataType_Double, &time_s, &begin_s, &end_s, format.c_str());
  const bool active = ImGui::IsItemActive();
  if (changed || (active && !clock.held())) clock.seek(at, time_s);
  clock.set_held(at, active);
  ui.mark("scrubber");
}

void draw_numbers(Ui& ui) {
  if (!ui.picture) return;
  const render::FrameRecord& record = ui.picture->a.record;
  const io::Image8& image = ui.picture->a.result.image;
  const double ms = record.timings.total_ms + (ui.picture->b ? ui.picture->b->record.timings.total_ms : 0);
  const std::string text = fmt::format("{:.1f} ms   {}x{}", ms, image.width, image.height);
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  if (ImGui::GetContentRegionAvail().x < width + ui.px(16)) return;
  ImGui::SameLine(ImGui::GetWindowWidth() - width - ImGui::GetStyle().WindowPadding.x);
  ImGui::AlignTextToFramePadding();
  dim_text(text.c_str());
}

}  // namespace

void choose_clip(ViewState& state, int clip) {
  AnimationClock clock(&state.scene->scene.clips[static_cast<std::size_t>(clip)], state.options.fps);
  clock.set_loop(now(), state.clock.loop());
  clock.set_speed(now(), state.clock.speed());
  clock.set_fixed_step(now(), state.clock.fixed_step());
  if (state.clock.playing()) clock.play(now());
  state.clock = clock;
  state.clip = clip;
}

void toggle_playing(ViewState& state) {
  state.clock.playing() ? state.clock.pause(now()) : state.clock.play(now());
}

void draw_transport(Ui& ui, Area area) {
  ImGui::SetNextWindowPos(area.low);
  ImGui::SetNextWindowSize(area.size);
  ImGui::Begin("##transport", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav);
  draw_scrubber(ui);
  draw_buttons(ui);
  if (area.size.x > ui.px(560)) {
    ImGui::SameLine(0, ui.px(16));
    draw_speed(ui);
    ImGui::SameLine();
    draw_numbers(ui);
  }
  ImGui::End();
}

}  // namespace tenebra::viewer
