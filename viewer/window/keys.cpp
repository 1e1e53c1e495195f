// The keyboard, and the overlay that explains it.
#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

/// What the overlay says: one line per key, below titles; "key: what it does".
constexpr const char* time_and_camera =
    "Time\n"
    "Space: play, pause\n"
    "Left, Right: one frame back or forward\n"
    "Home, End: first, last frame\n"
    "[  ]: slower, faster; past zero backwards\n"
    "L: loop\n"
    "O: record the animation as pictures, or stop\n"
    "T: start or end the log of frame times\n"
    "Camera\n"
    "drag: orbit, or look around while flying\n"
    "right drag: pan\n"
    "wheel: nearer, farther; flying: speed\n"
    "W A S D Q E: fly; Shift: faster\n"
    "F, double click: look at this point and orbit it\n"
    "G: see the whole scene\n"
    "C: scene's camera, orbit, fly\n"
    "Backspace: reset the camera\n"
    "Ctrl+C: copy what is shown as options\n";
constexpr const char* methods_and_window =
    "Scene\n"
    "Ctrl+O: open a scene\n"
    "click, I: why is it dark here?\n"
    "Ctrl+Z, Ctrl+Shift+Z: undo, redo changes to the scene\n"
    "Methods\n"
    "1  2  3: no, hard, soft shadows\n"
    "4: ambient occlusion: none, adaptive, fields, rays\n"
    "V, Shift+V: next, previous variant of the hard shadows\n"
    "X: flip A and B\n"
    "B: compare A with B\n"
    "N: heat map of nodes\n"
    "M: classes of the soft shadows\n"
    "Y: try settings on this scene, or end that\n"
    "Window\n"
    "P, Shift+P: save the picture, the window\n"
    "Tab: show or hide the panel\n"
    "F6: arrows, Space and Enter in the panel; Esc: out of it\n"
    "Esc: cancel what takes long\n"
    "R: compute again what was cancelled\n"
    "?: this overview\n"
    "Ctrl+Q: quit\n";

AnimationClock::Wall now() {
  return std::chrono::steady_clock::now();
}

void handle_time_keys(const Ui& ui) {
  ViewState& state = ui.state;
  AnimationClock& clock = state.clock;
  if (ui.pressed(key_code::space)) toggle_playing(state);
  if (ui.pressed(key_code::left, true)) clock.step(now(), -1);
  if (ui.pressed(key_code::right, true)) clock.step(now(), 1);
  if (ui.pressed(key_code::home)) clock.seek(now(), clock.start_s());
  if (ui.pressed(key_code::end)) clock.seek(now(), clock.frame_time_s(clock.frames() - 1));
  if (ui.pressed('[', true)) clock.set_speed(now(), clock.speed() - 0.25);
  if (ui.pressed(']', true)) clock.set_speed(now(), clock.speed() + 0.25);
  if (ui.pressed('L')) clock.set_loop(now(), !clock.loop());
}

void handle_method_keys(const Ui& ui) {
  ViewState& state = ui.state;
  render::RenderSettings& render = state.method().render;
  if (ui.pressed('1')) render.shadows = render::ShadowMode::none;
  if (ui.pressed('2')) render.shadows = render::ShadowMode::hard;
  if (ui.pressed('3')) render.shadows = render::ShadowMode::soft;
  if (ui.pressed('4')) render.ao.mode = static_cast<AoMode>((static_cast<int>(render.ao.mode) + 1) % 4);
  if (ui.pressed('V', true)) {
    constexpr int variants = static_cast<int>(Variant::precise_seatp) + 1;
    const int step = ui.pressed('V', true)->shift ? variants - 1 : 1;
    render.hard.variant = static_cast<Variant>((static_cast<int>(render.hard.variant) + step) % variants);
  }
  if (ui.pressed('X')) flip_slots(state);
  if (ui.pressed('B')) state.compare = !state.compare;
  if (ui.pressed('N')) state.overlay = state.overlay == Overlay::nodes ? Overlay::none : Overlay::nodes;
  if (ui.pressed('M')) state.overlay = state.overlay == Overlay::classes ? Overlay::none : Overlay::classes;
}

void handle_camera_keys(Ui& ui) {
  ViewState& state = ui.state;
  if (ui.pressed('C')) {
    leave_scene_camera(ui, static_cast<CameraMode>((static_cast<int>(state.camera_mode) + 1) % 3));
  }
  if (!ui.pressed(key_code::backspace)) return;
  state.reset_camera();
}

/// The key of a capital letter: by name for Dear ImGui 1.87 and later, by the window system's code before.
ImGuiKey key_of(char letter) {
#if IMGUI_VERSION_NUM >= 18700
  return static_cast<ImGuiKey>(ImGuiKey_A + (letter - 'A'));
#else
  return letter;
#endif
}

void fly_by_keys(Ui& ui, float seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!flies(io) || !ui.picture) return;
  if (ui.state.camera_mode != CameraMode::fly) leave_scene_camera(ui, CameraMode::fly);
  const auto axis = [](char positive, char negative) {
    return static_cast<float>(ImGui::IsKeyDown(key_of(positive))) -
           static_cast<float>(ImGui::IsKeyDown(key_of(negative)));
  };
  const float metres = ui.state.fly_speed * seconds * (io.KeyShift ? 4.0f : 1.0f);
  fly(ui.state.free, glm::vec3(axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')) * metres);
}

void handle_window_keys(Ui& ui) {
  if (const auto p = ui.pressed('P')) (p->shift ? ui.actions.window_shot : ui.actions.picture_shot) = true;
  if (ui.pressed('T')) ui.actions.toggle_log = true;
  if (ui.pressed('O')) ui.actions.record = true;
  if (ui.pressed('G')) ui.actions.frame_all = true;
  if (ui.pressed('R')) ui.actions.retry = true;
  if (ui.pressed('Y')) ui.actions.trade = true;
  if (ui.pressed(key_code::tab)) ui.state.panel = !ui.state.panel;
  if (!ui.pressed(key_code::escape)) return;
  if (!ui.state.help && ui.answer && !ui.worker.drawing) {
    ui.actions.end_explanation = true;
  } else if (!ui.state.help) {
    ui.actions.cancel = true;
  }
  ui.state.help = false;
}

void handle_command_keys(Ui& ui, const KeyPress& press) {
  if (!press.ctrl) return;
  if (press.code == 'C') ui.actions.copy_arguments = true;
  if (press.code == 'O') ui.actions.open_dialog = true;
  if (press.code == 'Q') ui.actions.quit = true;
  if (press.code == 'Z') (press.shift ? ui.actions.redo : ui.actions.undo) = true;
  if (press.code == 'Y') ui.actions.redo = true;
}

bool typed(ImWchar character) {
  const ImVector<ImWchar>& queue = ImGui::GetIO().InputQueueCharacters;
  return std::find(queue.begin(), queue.end(), character) != queue.end();
}

void help_column(const char* lines) {
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (colon == std::string::npos) {  // a title
      if (stream.tellg() > static_cast<std::streamoff>(line.size() + 1)) ImGui::Spacing();
      ImGui::TextUnformatted(line.c_str());
      continue;
    }
    ImGui::PushStyleColor(ImGuiCol_Text, palette::accent);
    ImGui::TextUnformatted(line.substr(0, colon).c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine(ImGui::GetFontSize() * 8);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(line.substr(colon + 2).c_str());
    ImGui::PopTextWrapPos();
  }
}

}  // namespace

bool flies(const ImGuiIO& io) {
  if (io.WantTextInput || io.KeyCtrl) return false;
  constexpr std::array keys{'W', 'A', 'S', 'D', 'Q', 'E'};
  return std::any_of(keys.begin(), keys.end(), [](char key) { return ImGui::IsKeyDown(key_of(key)); });
}

void flip_slots(ViewState& state) {
  state.active = 1 - state.active;
  if (state.compare && (state.show == CompareView::a || state.show == CompareView::b)) {
    state.show = state.active == 0 ? CompareView::a : CompareView::b;
  } else if (state.compare) {
    state.show = CompareView::b;
    state.active = 1;
  }
}

void handle_keys(Ui& ui, float seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ui.state.open_dialog || io.WantTextInput) return;
  if (ui.pressed(key_code::f6)) ui.state.keys_in_panel = !ui.state.keys_in_panel;
  if (ui.state.keys_in_panel && ui.pressed(key_code::escape) && !ImGui::IsAnyItemActive())
    ui.state.keys_in_panel = false;
  ui.state.keys_in_panel &= ui.state.panel;
  for (const KeyPress& press : ui.keys) handle_command_keys(ui, press);
  if (ui.state.keys_in_panel) return;
  if (typed('?')) ui.state.help = !ui.state.help;
  for (const KeyPress& press : ui.keys) {  // one by one: two presses of a key are two
    Ui one = ui;
    one.keys = {&press, 1};
    handle_time_keys(one);
    handle_method_keys(one);
    handle_camera_keys(one);
    handle_window_keys(one);
  }
  fly_by_keys(ui, seconds);
}

void draw_help(Ui& ui, ImVec2 window) {
  const bool wide = window.x > ui.px(760);
  const ImVec2 size{std::min(window.x - ui.px(20), ui.px(wide ? 740.0f : 380.0f)), window.y - ui.px(20)};
  ImGui::SetNextWindowPos({(window.x - size.x) / 2, window.y / 2}, ImGuiCond_Always, {0, 0.5f});
  ImGui::SetNextWindowSizeConstraints({size.x, 0}, size);
  ImGui::SetNextWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("##help", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::Columns(wide ? 2 : 1, nullptr, false);
  help_column(time_and_camera);
  if (wide) ImGui::NextColumn();
  help_column(methods_and_window);
  ImGui::Columns(1);
  ImGui::Spacing();
  dim_text("Every setting is also an option: tenebra view --help");
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace tenebra::viewer
