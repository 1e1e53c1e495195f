#include "window/panels/light_handles.h"

#include <fmt/core.h>

#include <array>

namespace tenebra::viewer {
namespace {

constexpr float handle_px = 9;
constexpr float arrow_px = 64;
constexpr float dial_px = 84;  // from a light to its tip
constexpr ImU32 shining = IM_COL32(255, 220, 120, 255);
constexpr std::array<ImU32, 3> axis_colors{IM_COL32(236, 96, 96, 255), IM_COL32(120, 210, 110, 255),
                                           IM_COL32(104, 150, 255, 255)};

bool is_shown(const ViewState& state, int light) {
  return !stage::edit_of(state.edits.lights, light).deleted;
}

/// Right, up and towards the eye, of a view.
glm::dmat3 axes_of(const ViewRays& view) {
  const glm::dvec3 right = glm::normalize(glm::dvec3(view.dx)), up = -glm::normalize(glm::dvec3(view.dy));
  return {right, up, glm::cross(right, up)};
}

/// The directions towards which a light's tip points: where it shines, of directional ones where it is.
glm::dvec3 tip_direction(const WorldLight& light, LightType type) {
  const glm::dvec3 direction(light.direction);
  return type == LightType::directional ? -direction : direction;
}

/// A direction or a way, metres, in the axes of the scene's file.
glm::vec3 in_file(const Ui& ui, const glm::dvec3& way) {
  return glm::vec3(ui.state.scene->scene.frame.direction_to_file(way));
}

/// The lights as their edits place them, of those in the picture.
std::vector<WorldLight> lights_in_view(const Ui& ui) {
  if (ui.picture->scene != ui.state.scene) return {};
  std::vector<WorldLight> lights =
      stage::edited_lights(ui.picture->lights, ui.state.edits.lights, ui.state.scene->scene.frame);
  // Until the next picture comes, this one has a light whose adding was undone.
  std::erase_if(lights, [&](const WorldLight& light) { return light.light >= ui.state.light_count(); });
  return lights;
}

/// Where a light's handles are in the window; none behind the eye.
struct Anchor {
  ImVec2 at;
  glm::dvec3 world{0.0};
};
std::optional<Anchor> anchor_of(const Ui& ui, const Stage& stage, const WorldLight& light, LightType type,
                                int place) {
  // A light without a place is turned about the middle of the scene, or of the view.
  const glm::dvec3 world =
      type == LightType::directional ? glm::dvec3(ui.state.centre) : glm::dvec3(light.position);
  const glm::dvec3 pixel = pixel_of(ui.picture->view, world);
  const io::Image8& image = ui.picture->a.result.image;
  const bool inside =
      pixel.z > 0 && pixel.x > 0 && pixel.y > 0 && pixel.x < image.width && pixel.y < image.height;
  if (type == LightType::directional && !inside)
    return Anchor{stage.at_pixel({image.width / 2.0, image.height / 2.0}, place), world};
  if (!(pixel.z > 0)) return std::nullopt;
  return Anchor{stage.at_pixel(pixel, place), world};
}

ImVec2 tip_at(const Ui& ui, const Anchor& anchor, const glm::dvec3& direction) {
  const glm::dvec3 seen = glm::transpose(axes_of(ui.picture->view)) * direction;
  return anchor.at +
         ImVec2(ui.px(dial_px) * static_cast<float>(seen.x), -ui.px(dial_px) * static_cast<float>(seen.y));
}

bool near(ImVec2 a, ImVec2 b, float distance) {
  return std::hypot(a.x - b.x, a.y - b.y) < distance;
}

/// The end of an arrow along a world axis: equally long for all lights, shorter where it points at the eye.
std::optional<ImVec2> arrow_at(const Ui& ui, const Stage& stage, const Anchor& anchor, int axis) {
  glm::dvec3 along(0);
  along[axis] = 1;
  const glm::dvec3 seen = glm::transpose(axes_of(ui.picture->view)) * along;
  const double length = std::hypot(seen.x, seen.y);
  if (length < 0.15) return std::nullopt;
  (void)stage;
  return anchor.at +
         ImVec2(ui.px(arrow_px) * static_cast<float>(seen.x), -ui.px(arrow_px) * static_cast<float>(seen.y));
}

class HandlePainter {
public:
  HandlePainter(Ui& ui, const Stage& stage, ImVec2 pointer, int place)
      : ui_(ui), stage_(stage), list_(*ImGui::GetWindowDrawList()), pointer_(pointer), place_(place) {}

  void draw(const WorldLight& light, LightType type) {
    const auto anchor = anchor_of(ui_, stage_, light, type, place_);
    if (!anchor) return;
    const bool selected = ui_.state.selected_light == light.light;
    const bool directional = type == LightType::directional;
    if (selected && !directional) draw_arrows(*anchor, light.light);
    if (directional || (selected && type != LightType::point)) {
      draw_tip(*anchor, light.light, tip_direction(light, type), directional);
    }
    if (!directional)
      draw_circle(anchor->at, light.light, LightPart::place, fmt::format("light.{}", light.light));
  }
  LightHandle under() const { return under_; }

private:
  ImU32 color_of(int light) const {
    return stage::edit_of(ui_.state.edits.lights, light).on ? shining : palette::dim;
  }
  bool take(ImVec2 at, float radius, LightHandle handle) {
    const bool hovered = near(at, pointer_, radius);
    if (hovered) under_ = handle;
    return hovered;
  }
  void mark(const std::string& name, ImVec2 at) {
    if (place_ == 0) ui_.marks[name] = {at.x - 2, at.y - 2, at.x + 2, at.y + 2};
  }

  void draw_circle(ImVec2 at, int light, LightPart part, const std::string& name) {
    const float r = ui_.px(handle_px);
    const bool hovered = take(at, r + 2, {light, part});
    const bool selected = ui_.state.selected_light == light;
    list_.AddCircleFilled(at, r, IM_COL32(0, 0, 0, 120));
    if (selected) list_.AddCircle(at, r + 3, palette::accent, 0, 1.5f);
    list_.AddCircle(at, r, color_of(light), 0, hovered ? 3.0f : 1.6f);
    const std::string number = fmt::format("{}", light);
    const ImVec2 size = ImGui::CalcTextSize(number.c_str());
    list_.AddText({at.x - size.x / 2, at.y - size.y / 2}, palette::text, number.c_str());
    mark(name, at);
  }

  void draw_arrows(const Anchor& anchor, int light) {
    constexpr const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
      const auto end = arrow_at(ui_, stage_, anchor, axis);
      if (!end) continue;
      const auto part = static_cast<LightPart>(static_cast<int>(LightPart::x) + axis);
      const bool hovered = take(*end, ui_.px(8), {light, part});
      const ImU32 color = axis_colors[static_cast<std::size_t>(axis)];
      list_.AddLine(anchor.at, *end, color, hovered ? 3.5f : 2.0f);
      list_.AddRectFilled(*end - ImVec2(5, 5), *end + ImVec2(5, 5), color, 1);
      mark(fmt::format("light.{}.{}", light, names[axis]), *end);
    }
  }

  /// A sun has its circle at the tip: it is all that there is to hold.
  void draw_tip(const Anchor& anchor, int light, const glm::dvec3& direction, bool sun) {
    const ImVec2 tip = tip_at(ui_, anchor, direction);
    const ImU32 color = (color_of(light) & 0x00ffffffu) | IM_COL32(0, 0, 0, 150);
    list_.AddLine(anchor.at, tip, color, 1.5f);
    if (sun) {
      list_.AddCircle(anchor.at, ui_.px(3), color);
      return draw_circle(tip, light, LightPart::aim, fmt::format("light.{}", light));
    }
    const bool hovered = take(tip, ui_.px(8), {light, LightPart::aim});
    list_.AddCircleFilled(tip, ui_.px(hovered ? 6.5f : 5), color_of(light));
    mark(fmt::format("light.{}.aim", light), tip);
  }

  Ui& ui_;
  const Stage& stage_;
  ImDrawList& list_;
  ImVec2 pointer_;
  int place_;
  LightHandle under_;
};

void move_in_plane(Ui& ui, const Stage& stage, const WorldLight& light, ImVec2 pointer) {
  const ViewRays& view = ui.picture->view;
  const glm::dvec3 at = light.position;
  const glm::dvec3 old = pixel_of(view, at);
  const glm::dvec2 now = stage.pixel_at(pointer);
  const double depth = old.z * std::pow(1.05, static_cast<double>(ImGui::GetIO().MouseWheel));
  const glm::dvec3 across = now.x * glm::dvec3(view.dx) + now.y * glm::dvec3(view.dy);
  const glm::dvec3 to = glm::dvec3(view.eye) + (view.orthographic ? across + depth * glm::dvec3(view.d0)
                                                                  : depth * (glm::dvec3(view.d0) + across));
  ui.state.light_edit(light.light).move += in_file(ui, to - at);
}

void move_along(Ui& ui, const Stage& stage, const WorldLight& light, int axis, ImVec2 moved) {
  glm::dvec3 along(0);
  along[axis] = 1;
  const double step_m = 1e-3 * ui.state.diagonal_m;
  const glm::dvec3 at = light.position;
  const glm::dvec3 here = pixel_of(ui.picture->view, at),
                   there = pixel_of(ui.picture->view, at + step_m * along);
  const ImVec2 arrow = stage.at_pixel(there, 0) - stage.at_pixel(here, 0);
  const double length2 = static_cast<double>(arrow.x) * arrow.x + static_cast<double>(arrow.y) * arrow.y;
  if (!(here.z > 0) || !(there.z > 0) || !(length2 > 0)) return;
  const double steps =
      (static_cast<double>(moved.x) * arrow.x + static_cast<double>(moved.y) * arrow.y) / length2;
  if (std::abs(steps) < 1e4) ui.state.light_edit(light.light).move += in_file(ui, steps * step_m * along);
}

/// Moves the tip on a sphere around the light; it stays on the half, in front or behind, that it is on.
void aim(Ui& ui, const Anchor& anchor, const WorldLight& light, LightType type, ImVec2 pointer) {
  const glm::dmat3 axes = axes_of(ui.picture->view);
  const glm::dvec3 before = glm::transpose(axes) * tip_direction(light, type);
  const double radius = ui.px(dial_px);
  glm::dvec2 to{(pointer.x - anchor.at.x) / radius, -(pointer.y - anchor.at.y) / radius};
  const double length = glm::length(to);
  if (length > 0.999) to *= 0.999 / length;
  const double depth = std::sqrt(1 - glm::dot(to, to));
  const glm::dvec3 tip = axes * glm::dvec3(to, before.z < 0 ? -depth : depth);
  ui.state.light_edit(light.light).direction = in_file(ui, type == LightType::directional ? -tip : tip);
}

}  // namespace

LightHandle draw_light_handles(Ui& ui, const Stage& stage, ImVec2 pointer) {
  LightHandle under;
  if (!ui.state.light_handles) return under;
  for (int place = 0; place < stage.places(); ++place) {
    HandlePainter painter(ui, stage, pointer, place);
    for (const WorldLight& light : lights_in_view(ui)) {
      if (is_shown(ui.state, light.light)) painter.draw(light, ui.state.light_type(light.light));
    }
    if (painter.under().light >= 0) under = painter.under();
  }
  return under;
}

void drag_light(Ui& ui, const Stage& stage, LightHandle handle, ImVec2 pointer) {
  for (const WorldLight& light : lights_in_view(ui)) {
    if (light.light != handle.light) continue;
    const LightType type = ui.state.light_type(light.light);
    if (handle.part == LightPart::place) return move_in_plane(ui, stage, light, pointer);
    if (handle.part == LightPart::aim) {
      if (const auto anchor = anchor_of(ui, stage, light, type, 0)) aim(ui, *anchor, light, type, pointer);
      return;
    }
    const int axis = static_cast<int>(handle.part) - static_cast<int>(LightPart::x);
    return move_along(ui, stage, light, axis, ImGui::GetIO().MouseDelta);
  }
}

}  // namespace tenebra::viewer
