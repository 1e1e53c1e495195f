// The picture in the window, and what the mouse does in it: orbit, fly, drag a light, wipe.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "window/frames/overlay_image.h"
#include "window/panels/light_handles.h"

namespace tenebra::viewer {
namespace {

constexpr float radians_a_pixel = 0.006f;

void label(ImVec2 at, const char* text) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text);
  list.AddRectFilled(at, at + ImVec2(size.x + 14, size.y + 8), palette::shade, 3);
  list.AddText(at + ImVec2(7, 4), palette::text, text);
}

void draw_labels(Ui& ui, const Stage& stage) {
  const Area place = stage.place();
  if (!stage.both()) return;
  const CompareView show = ui.state.show;
  const ImVec2 left = place.low + ImVec2(8, place.size.y - 36);
  if (show == CompareView::wipe) {
    const float x = place.low.x + std::round(place.size.x * ui.state.wipe);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, place.low.y}, {x, place.low.y + place.size.y}, palette::text, 1.5f);
    list.AddCircleFilled({x, place.low.y + place.size.y / 2}, ui.px(7), palette::text);
    ui.marks["wipe"] = {x - 4, place.low.y, x + 4, place.low.y + place.size.y};
  }
  if (show == CompareView::difference) {
    const PictureDifference& difference = ui.picture->difference;
    label(left, fmt::format("|A - B| x {}   {} of {} pixels differ, largest {} of 255", ui.state.gain,
                            difference.differing, difference.pixels, difference.largest)
                    .c_str());
    return;
  }
  label(left, show == CompareView::b ? "B" : "A");
  if (show == CompareView::wipe) label(place.low + ImVec2(place.size.x - 32, place.size.y - 36), "B");
  if (show == CompareView::side_by_side)
    label(stage.at_pixel({0, ui.picture->a.result.image.height}, 1) + ImVec2(8, -36), "B");
}

/// Says that the picture is a preview, wherever it is one.
void draw_preview_mark(Ui& ui, Area place) {
  if (ui.picture->preview.empty()) return;
  const std::string text = "Preview: " + ui.picture->preview;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 low{std::round(place.low.x + (place.size.x - size.x) / 2 - ui.px(14)), place.low.y + ui.px(8)};
  const ImVec2 high = low + ImVec2(size.x + ui.px(28), size.y + ui.px(8));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, palette::shade, 3);
  list.AddCircleFilled({low.x + ui.px(11), (low.y + high.y) / 2}, ui.px(4), palette::warning);
  list.AddText(low + ImVec2(ui.px(21), ui.px(4)), palette::text, text.c_str());
  ui.marks["preview"] = {low.x, low.y, high.x, high.y};
}

void draw_heat_legend(Ui& ui, Area place) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OverlayImage& overlay = ui.picture->overlay;
  const ImVec2 low = place.low + ImVec2(place.size.x - ui.px(228), ui.px(8));
  list.AddRectFilled(low, low + ImVec2(ui.px(220), ui.px(62)), palette::shade, 3);
  const ImVec2 bar = low + ImVec2(ui.px(10), ui.px(26));
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const glm::u8vec3 c = heat_color((i + 0.5) / steps);
    const float x = bar.x + ui.px(5) * static_cast<float>(i);
    list.AddRectFilled({x, bar.y}, {x + ui.px(5), bar.y + ui.px(12)}, IM_COL32(c.r, c.g, c.b, 255));
  }
  list.AddText(low + ImVec2(ui.px(10), ui.px(5)), palette::text,
               fmt::format("node tests per pixel, mean {:.1f}", overlay.mean).c_str());
  list.AddText(bar + ImVec2(0, ui.px(14)), palette::dim, "0");
  const std::string right = fmt::format("{:.1f} (most {:.1f})", overlay.highest, overlay.peak);
  list.AddText(bar + ImVec2(ui.px(200) - ImGui::CalcTextSize(right.c_str()).x, ui.px(14)), palette::dim,
               right.c_str());
}

void draw_class_legend(Ui& ui, Area place) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = place.low + ImVec2(place.size.x - ui.px(258), ui.px(8));
  const float line = ImGui::GetTextLineHeight() + ui.px(3);
  const auto& sizes = ui.picture->overlay.class_sizes;
  const float height = line * static_cast<float>(sizes.size()) + ui.px(14);
  list.AddRectFilled(low, low + ImVec2(ui.px(250), height), palette::shade, 3);
  double pixels = 0;
  for (const std::size_t size : sizes) pixels += static_cast<double>(size);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const auto soft_class = static_cast<SoftClass>(i);
    const glm::u8vec3 c = class_color(soft_class);
    const ImVec2 at = low + ImVec2(ui.px(10), ui.px(7) + line * static_cast<float>(i));
    list.AddRectFilled(at + ImVec2(0, ui.px(3)), at + ImVec2(ui.px(12), ui.px(15)),
                       IM_COL32(c.r, c.g, c.b, 255), 2);
    list.AddText(at + ImVec2(ui.px(20), 0), palette::text, class_name(soft_class));
    const std::string text = fmt::format("{:.1f} %", 100 * static_cast<double>(sizes[i]) / pixels);
    list.AddText(at + ImVec2(ui.px(230) - ImGui::CalcTextSize(text.c_str()).x, 0), palette::dim,
                 text.c_str());
  }
}

void move_camera(Ui& ui, const Stage& stage, ImVec2 moved, int button, int height) {
  ViewState& state = ui.state;
  if (moved.x == 0 && moved.y == 0) return;
  if (state.camera_mode == CameraMode::scene) leave_scene_camera(ui, CameraMode::orbit);
  if (button != ImGuiMouseButton_Left) {
    const glm::vec3 before = state.free.target;
    pan(state.free, {moved.x, moved.y}, height);
    if (state.pivot) *state.pivot += state.free.target - before;
    return;
  }
  if (state.camera_mode == CameraMode::fly) {
    return look_around(state.free, moved.x * radians_a_pixel, moved.y * radians_a_pixel);
  }
  if (!std::exchange(state.pivot_asked, true)) {
    ui.actions.pivot = stage.place_under(ImGui::GetIO().MouseClickedPos[button]);
  }
  const float right = moved.x * radians_a_pixel, down = moved.y * radians_a_pixel;
  state.pivot ? orbit(state.free, right, down, *state.pivot) : orbit(state.free, right, down);
}

void turn_wheel(Ui& ui, float steps) {
  if (steps == 0) return;
  if (ui.state.camera_mode == CameraMode::fly) {
    ui.state.fly_speed *= std::pow(1.2f, steps);
    return;
  }
  if (ui.state.camera_mode == CameraMode::scene) leave_scene_camera(ui, CameraMode::orbit);
  zoom(ui.state.free, steps);
}

/// Whether the mouse has moved since the button went down: what makes a click a drag.
bool dragged(int button) {
  constexpr float click_px = 3;
  return ImGui::GetIO().MouseDragMaxDistanceSqr[button] > click_px * click_px;
}

enum class Hand { none, camera, light, wipe };

/// What the hand holds from press to release lives in ImGui's storage of the window.
void use_hand(Ui& ui, const Stage& stage, Area area) {
  const ImGuiIO& io = ImGui::GetIO();
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID hand_id = ImGui::GetID("hand"), light_id = ImGui::GetID("light"),
                part_id = ImGui::GetID("part");
  ImGui::SetCursorScreenPos(area.low);
  ImGui::InvisibleButton("view", area.size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ui.mark("view");
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive(),
             pressed = ImGui::IsItemActivated();
  const LightHandle under =
      draw_light_handles(ui, stage, hovered || held ? io.MousePos : ImVec2(-1e6f, -1e6f));
  const Area place = stage.place();
  const float wipe_x = place.low.x + place.size.x * ui.state.wipe;
  const bool wiping = stage.both() && ui.state.show == CompareView::wipe;
  if (pressed) {
    const bool left = io.MouseClicked[ImGuiMouseButton_Left];
    const bool on_wipe = wiping && left && std::abs(io.MousePos.x - wipe_x) < ui.px(6);
    const Hand hand = on_wipe ? Hand::wipe : left && under.light >= 0 ? Hand::light : Hand::camera;
    storage.SetInt(hand_id, static_cast<int>(hand));
    storage.SetInt(light_id, under.light);
    storage.SetInt(part_id, static_cast<int>(under.part));
    // Selecting a light in the view does not scroll the panel.
    if (hand == Hand::light) ui.state.selected_light = ui.state.shown_light = under.light;
  }
  const bool drags =
      dragged(ImGuiMouseButton_Left) || !io.MouseDown[ImGuiMouseButton_Left] || io.MouseWheel != 0;
  const auto hand = held ? static_cast<Hand>(storage.GetInt(hand_id)) : Hand::none;
  if (hand == Hand::wipe)
    ui.state.wipe = std::clamp((io.MousePos.x - place.low.x) / place.size.x, 0.0f, 1.0f);
  const LightHandle taken{storage.GetInt(light_id), static_cast<LightPart>(storage.GetInt(part_id))};
  if (hand == Hand::light && !pressed && drags) drag_light(ui, stage, taken, io.MousePos);
  if (hand == Hand::camera) {
    const int button = io.MouseDown[ImGuiMouseButton_Left] ? ImGuiMouseButton_Left : ImGuiMouseButton_Right;
    if (drags) move_camera(ui, stage, io.MouseDelta, button, static_cast<int>(place.size.y));
  }
  const bool turns = hovered && hand != Hand::light;
  if (turns) turn_wheel(ui, io.MouseWheel);
  const bool released = ImGui::IsItemDeactivated() && io.MouseReleased[ImGuiMouseButton_Left];
  const bool was_camera = storage.GetInt(hand_id) == static_cast<int>(Hand::camera);
  const bool explain_key = hovered && !io.WantTextInput && ui.pressed('I');
  if ((released && was_camera && !dragged(ImGuiMouseButton_Left)) || explain_key)
    ui.actions.explain = stage.place_under(io.MousePos);
  const bool clicked = hovered && io.MouseDoubleClicked[ImGuiMouseButton_Left] && under.light < 0;
  const bool focus_key = hovered && !io.WantTextInput && ui.pressed('F');
  if (clicked || focus_key) ui.actions.focus = stage.place_under(io.MousePos);
}

}  // namespace

Size picture_size(const ViewState& state, Area view, float pixels_a_unit) {
  const bool side = state.compare && state.show == CompareView::side_by_side;
  const float width = side ? (view.size.x - gap_px) / 2 : view.size.x;
  const auto pixels = [&](float length) {
    return std::clamp(static_cast<int>(length * pixels_a_unit), 16, largest_side_px);
  };
  return {pixels(width), pixels(view.size.y)};
}

void leave_scene_camera(Ui& ui, CameraMode mode) {
  ViewState& state = ui.state;
  if (!ui.picture) return;  // nothing to start from yet
  if (state.camera_mode == CameraMode::scene) {
    const io::Image8& image = ui.picture->a.result.image;
    const ViewRays& view = ui.picture->view;
    const float distance = std::max(glm::distance(state.centre, view.eye), 1e-3f * state.diagonal_m);
    state.free = free_camera(view, image.width, image.height, distance);
    state.pivot.reset();
    state.pivot_asked = false;
  }
  state.camera_mode = mode;
}

void draw_view(Ui& ui, const ViewTextures& textures, Area area) {
  ImGui::SetNextWindowPos(area.low);
  ImGui::SetNextWindowSize(area.size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(9, 10, 12, 255));
  ImGui::Begin("##view", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
  if (ui.picture && area.size.x >= 1 && area.size.y >= 1) {
    Stage stage(ui, area);
    stage.draw(textures);
    draw_sun_path(ui, stage);
    draw_explanation_lines(ui, stage);
    const Area place = stage.place();
    ui.marks["picture"] = {place.low.x, place.low.y, place.low.x + place.size.x, place.low.y + place.size.y};
    use_hand(ui, stage, area);
    draw_labels(ui, stage);
    draw_preview_mark(ui, place);
    if (stage.shows_hours()) {
      draw_hours_legend(ui, place);
    } else if (stage.shows_overlay()) {
      ui.state.overlay == Overlay::nodes ? draw_heat_legend(ui, place) : draw_class_legend(ui, place);
    }
  }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

}  // namespace tenebra::viewer
