// The picture in the window, and the hand on it: orbit, fly, drag a light, wipe.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "window/panels/overlay_image.h"
#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

constexpr float radians_a_pixel = 0.006f;
constexpr float handle_px = 9;
constexpr float gap_px = 4;  // between side by side

ImVec2 operator+(ImVec2 a, ImVec2 b) {
  return {a.x + b.x, a.y + b.y};
}

/// The largest place for a picture of `width` x `height` within `area`, centred on whole pixels; never
/// enlarged.
Area fit(Area area, int width, int height) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const float factor = std::min({1.0f, area.size.x / w, area.size.y / h});
  const ImVec2 size{factor == 1 ? w : std::floor(w * factor), factor == 1 ? h : std::floor(h * factor)};
  return {{std::floor(area.low.x + (area.size.x - size.x) / 2),
           std::floor(area.low.y + (area.size.y - size.y) / 2)},
          size};
}

Area half_of(Area area, bool right) {
  const float width = (area.size.x - gap_px) / 2;
  return {{right ? area.low.x + area.size.x - width : area.low.x, area.low.y}, {width, area.size.y}};
}

/// What is drawn of A and B where.
class Stage {
public:
  Stage(const Ui& ui, Area area) : ui_(ui), list_(*ImGui::GetWindowDrawList()) {
    const Size whole = ui.picture->whole;
    side_ = both() && ui.state.show == CompareView::side_by_side;
    places_[0] = fit(side_ ? half_of(area, false) : area, whole.width, whole.height);
    places_[1] = side_ ? fit(half_of(area, true), whole.width, whole.height) : places_[0];
  }

  /// It explains A: where A is not to be seen, neither is it.
  bool shows_overlay() const {
    const bool hides =
        both() && (ui_.state.show == CompareView::b || ui_.state.show == CompareView::difference);
    return !hides && ui_.state.overlay != Overlay::none && ui_.picture->overlay.kind == ui_.state.overlay;
  }
  bool both() const { return ui_.state.compare && ui_.picture->b.has_value(); }
  Area place() const { return places_[0]; }

  void draw(const ViewTextures& textures) {
    const CompareView show = both() ? ui_.state.show : CompareView::a;
    if (show == CompareView::difference) return image(textures.difference, places_[0], 0, 1);
    if (show == CompareView::b) return image(textures.b, places_[0], 0, 1);
    image(textures.a, places_[0], 0, show == CompareView::wipe ? ui_.state.wipe : 1);
    if (show == CompareView::wipe) image(textures.b, places_[0], ui_.state.wipe, 1);
    if (show == CompareView::side_by_side) image(textures.b, places_[1], 0, 1);
    if (shows_overlay()) {
      const float to = show == CompareView::wipe ? ui_.state.wipe : 1;
      image(textures.overlay, places_[0], 0, to, ui_.state.overlay_opacity);
    }
  }

  /// Pixel of the picture under `at`, in whichever of the places it is.
  glm::vec2 pixel_at(ImVec2 at) const {
    const Area& area = side_ && at.x >= places_[1].low.x ? places_[1] : places_[0];
    const base::Image8& image = ui_.picture->a.result.image;
    return {(at.x - area.low.x) / area.size.x * static_cast<float>(image.width),
            (at.y - area.low.y) / area.size.y * static_cast<float>(image.height)};
  }
  ImVec2 at_pixel(glm::dvec2 pixel, int place) const {
    const Area& area = places_[static_cast<std::size_t>(place)];
    const base::Image8& image = ui_.picture->a.result.image;
    return {area.low.x + static_cast<float>(pixel.x / image.width) * area.size.x,
            area.low.y + static_cast<float>(pixel.y / image.height) * area.size.y};
  }
  int places() const { return side_ ? 2 : 1; }

private:
  void image(const PictureTexture& texture, Area area, float from, float to, float opacity = 1) {
    if (texture.width() == 0) return;
    // The cut lies on a whole pixel of the window, so that both sides stay exact.
    const float left = std::round(area.size.x * from), right = std::round(area.size.x * to);
    list_.AddImage(texture.id(), {area.low.x + left, area.low.y},
                   {area.low.x + right, area.low.y + area.size.y}, {left / area.size.x, 0},
                   {right / area.size.x, 1},
                   IM_COL32(255, 255, 255, static_cast<int>(std::round(255 * opacity))));
  }

  const Ui& ui_;
  ImDrawList& list_;
  std::array<Area, 2> places_;
  bool side_ = false;
};

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

/// What is shown is not all that was asked for yet: that is never left unsaid.
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
  list.AddRectFilled(low, low + ImVec2(ui.px(250), line * 7 + ui.px(14)), palette::shade, 3);
  double pixels = 0;
  for (const std::size_t size : ui.picture->overlay.class_sizes) pixels += static_cast<double>(size);
  for (int i = 0; i < 7; ++i) {
    const auto soft_class = static_cast<SoftClass>(i);
    const glm::u8vec3 c = class_color(soft_class);
    const ImVec2 at = low + ImVec2(ui.px(10), ui.px(7) + line * static_cast<float>(i));
    list.AddRectFilled(at + ImVec2(0, ui.px(3)), at + ImVec2(ui.px(12), ui.px(15)),
                       IM_COL32(c.r, c.g, c.b, 255), 2);
    list.AddText(at + ImVec2(ui.px(20), 0), palette::text, class_name(soft_class));
    const double share =
        static_cast<double>(ui.picture->overlay.class_sizes[static_cast<std::size_t>(i)]) / pixels;
    const std::string text = fmt::format("{:.1f} %", 100 * share);
    list.AddText(at + ImVec2(ui.px(230) - ImGui::CalcTextSize(text.c_str()).x, 0), palette::dim,
                 text.c_str());
  }
}

bool has_place(const ViewState& state, const WorldLight& light) {
  return state.scene->scene.lights[static_cast<std::size_t>(light.light)].type != LightType::directional;
}

glm::vec3 moved_place(const ViewState& state, const WorldLight& light) {
  return light.position + edit_of(state.lights, light.light).move;
}

/// Draws the lights' handles; the light under the pointer, or -1.
int draw_light_handles(Ui& ui, const Stage& stage, ImVec2 pointer) {
  int under = -1;
  if (!ui.state.light_handles || ui.picture->scene != ui.state.scene) return under;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const WorldLight& light : ui.picture->lights) {
    if (!has_place(ui.state, light)) continue;
    const glm::dvec3 pixel = pixel_of(ui.picture->view, moved_place(ui.state, light));
    if (!(pixel.z > 0)) continue;
    const bool on = edit_of(ui.state.lights, light.light).on;
    for (int place = 0; place < stage.places(); ++place) {
      const ImVec2 at = stage.at_pixel(pixel, place);
      const float r = ui.px(handle_px);
      const bool hovered = std::hypot(at.x - pointer.x, at.y - pointer.y) < r + 2;
      if (hovered) under = light.light;
      list.AddCircleFilled(at, r, IM_COL32(0, 0, 0, 120));
      list.AddCircle(at, r, on ? IM_COL32(255, 220, 120, 255) : palette::dim, 0, hovered ? 3.0f : 1.6f);
      const std::string number = fmt::format("{}", light.light);
      const ImVec2 size = ImGui::CalcTextSize(number.c_str());
      list.AddText({at.x - size.x / 2, at.y - size.y / 2}, palette::text, number.c_str());
      if (place == 0)
        ui.marks[fmt::format("light.{}", light.light)] = {at.x - 2, at.y - 2, at.x + 2, at.y + 2};
    }
  }
  return under;
}

/// Moves a light in the plane through it that faces the view; the wheel moves it along the line of sight.
void drag_light(Ui& ui, const Stage& stage, int light, ImVec2 pointer) {
  for (const WorldLight& placed : ui.picture->lights) {
    if (placed.light != light) continue;
    const ViewRays& view = ui.picture->view;
    const glm::dvec3 at = moved_place(ui.state, placed);
    const glm::dvec3 old = pixel_of(view, at);
    const glm::dvec2 now = stage.pixel_at(pointer);
    const double depth = old.z * std::pow(1.05, static_cast<double>(ImGui::GetIO().MouseWheel));
    const glm::dvec3 across = now.x * glm::dvec3(view.dx) + now.y * glm::dvec3(view.dy);
    const glm::dvec3 to = glm::dvec3(view.eye) + (view.orthographic ? across + depth * glm::dvec3(view.d0)
                                                                    : depth * (glm::dvec3(view.d0) + across));
    ui.state.light_edit(light).move += glm::vec3(to - at);
  }
}

void move_camera(Ui& ui, ImVec2 moved, int button, int height) {
  ViewState& state = ui.state;
  if (moved.x == 0 && moved.y == 0) return;
  if (state.camera_mode == CameraMode::scene) leave_scene_camera(ui, CameraMode::orbit);
  if (button != ImGuiMouseButton_Left) return pan(state.free, {moved.x, moved.y}, height);
  if (state.camera_mode == CameraMode::fly) {
    return look_around(state.free, moved.x * radians_a_pixel, moved.y * radians_a_pixel);
  }
  orbit(state.free, moved.x * radians_a_pixel, moved.y * radians_a_pixel);
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

enum class Hand { none, camera, light, wipe };

/// What the hand holds from press to release lives in ImGui's storage of the window.
void use_hand(Ui& ui, const Stage& stage, Area area) {
  const ImGuiIO& io = ImGui::GetIO();
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID hand_id = ImGui::GetID("hand"), light_id = ImGui::GetID("light");
  ImGui::SetCursorScreenPos(area.low);
  ImGui::InvisibleButton("view", area.size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ui.mark("view");
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive(),
             pressed = ImGui::IsItemActivated();
  const int under = draw_light_handles(ui, stage, hovered || held ? io.MousePos : ImVec2(-1e6f, -1e6f));
  const Area place = stage.place();
  const float wipe_x = place.low.x + place.size.x * ui.state.wipe;
  const bool wiping = stage.both() && ui.state.show == CompareView::wipe;
  if (pressed) {
    const bool left = io.MouseClicked[ImGuiMouseButton_Left];
    const bool on_wipe = wiping && left && std::abs(io.MousePos.x - wipe_x) < ui.px(6);
    const Hand hand = on_wipe ? Hand::wipe : left && under >= 0 ? Hand::light : Hand::camera;
    storage.SetInt(hand_id, static_cast<int>(hand));
    storage.SetInt(light_id, under);
  }
  const auto hand = held ? static_cast<Hand>(storage.GetInt(hand_id)) : Hand::none;
  if (hand == Hand::wipe)
    ui.state.wipe = std::clamp((io.MousePos.x - place.low.x) / place.size.x, 0.0f, 1.0f);
  if (hand == Hand::light && !pressed) drag_light(ui, stage, storage.GetInt(light_id), io.MousePos);
  if (hand == Hand::camera) {
    const int button = io.MouseDown[ImGuiMouseButton_Left] ? ImGuiMouseButton_Left : ImGuiMouseButton_Right;
    move_camera(ui, io.MouseDelta, button, static_cast<int>(place.size.y));
  }
  const bool turns = hovered && hand != Hand::light;
  if (turns) turn_wheel(ui, io.MouseWheel);
  const bool clicked = hovered && io.MouseDoubleClicked[ImGuiMouseButton_Left] && under < 0;
  const bool focus_key = hovered && !io.WantTextInput && ui.pressed('F');
  if (clicked || focus_key) ui.actions.focus = glm::ivec2(glm::floor(stage.pixel_at(io.MousePos)));
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
    const base::Image8& image = ui.picture->a.result.image;
    const ViewRays& view = ui.picture->view;
    const float distance = std::max(glm::distance(state.centre, view.eye), 1e-3f * state.diagonal_m);
    state.free = free_camera(view, image.width, image.height, distance);
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
    const Area place = stage.place();
    ui.marks["picture"] = {place.low.x, place.low.y, place.low.x + place.size.x, place.low.y + place.size.y};
    use_hand(ui, stage, area);
    draw_labels(ui, stage);
    draw_preview_mark(ui, place);
    if (stage.shows_overlay()) {
      ui.state.overlay == Overlay::nodes ? draw_heat_legend(ui, place) : draw_class_legend(ui, place);
    }
  }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

}  // namespace tenebra::viewer
