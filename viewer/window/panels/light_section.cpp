// The lights: on or off, colour, brightness, direction, place, size; adding and deleting them.
#include <fmt/core.h>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "session/scene_summary.h"
#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

/// As soft shadows have it: the light's own, the method's, the scene's, or a sun's.
float diameter_of(const Ui& ui, const Light& light, const stage::LightEdit& edit) {
  const MethodOptions& method = ui.state.method();
  const float unsized = gives_no_size(method) ? 0 : unsized_sun_deg;
  const float of_scene = light.diameter_deg > 0 ? light.diameter_deg : unsized;
  return edit.diameter_deg.value_or(method.render.area_lights.sun_deg.value_or(of_scene));
}

/// A directional light with a disc is a sun.
std::string_view type_name(const Ui& ui, const Light& light, const stage::LightEdit& edit) {
  const bool sun = light.type == LightType::directional && diameter_of(ui, light, edit) > 0;
  return sun ? "sun" : session::light_type_name(light.type);
}

/// Width and height of a light where the user has not changed them: the scene's, of a point the method's; 0:
/// none.
glm::vec2 size_without_edit_m(const Ui& ui, int index, const Light& light) {
  if (light.type == LightType::point || light.type == LightType::spot) {
    const LightSize size = ui.state.method().light_size.value_or(LightSize{glm::vec2(unsized_percent), true});
    return size.size * (size.percent ? 0.01f * ui.state.diagonal_m : 1.0f);
  }
  for (const WorldLight& placed : ui.picture ? ui.picture->lights : std::vector<WorldLight>{}) {
    if (placed.light == index)
      return 2.0f * glm::vec2(glm::length(placed.axis_x), glm::length(placed.axis_y));
  }
  return light.size_m;
}

void edit_light_size(Ui& ui, int index, const Light& light, stage::LightEdit& edit) {
  row(ui, "  Size",
      "Width and height in metres, for soft shadows. A point light has the method's size until you change "
      "it.");
  glm::vec2 size_m = edit.size_m.value_or(size_without_edit_m(ui, index, light));
  if (ImGui::DragFloat2("##size", &size_m.x, 0.01f, 0.0f, 1000.0f, "%.2f m")) {
    // Both sides at once where one alone would leave the light without an area.
    if (!(size_m.x > 0)) size_m.x = size_m.y;
    if (!(size_m.y > 0)) size_m.y = size_m.x;
    edit.size_m.reset();
    if (size_m.x > 0) edit.size_m = size_m;
  }
  ui.mark(fmt::format("light.{}.size", index));
}

void edit_sun_size(Ui& ui, int index, const Light& light, stage::LightEdit& edit) {
  row(ui, "  Size", "Diameter as seen from the scene, for soft shadows; the sun's is 0.53. 0: hard shadows.");
  float diameter = diameter_of(ui, light, edit);
  if (ImGui::SliderFloat("##sun", &diameter, 0, 90, "%.2f deg",
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic))
    edit.diameter_deg = diameter;
  ui.mark(fmt::format("light.{}.diameter", index));
}

/// What traced the light in the picture that is shown; empty where nothing did, or soft shadows.
std::string method_of(const Ui& ui, int index) {
  if (!ui.picture) return "";
  for (const render::LightMethod& method : ui.picture->a.result.methods) {
    const auto number = static_cast<std::size_t>(method.light);
    if (number < ui.picture->lights.size() && ui.picture->lights[number].light == index)
      return std::string(variant_name(method.ran));
  }
  return "";
}

/// A direction to a light, or in which a light shines, in the scene's axes: by compass and height, as the
/// sun's.
struct Bearing {
  float compass_deg = 0;  ///< 0 is -Z, 90 is +X
  float height_deg = 0;   ///< above the ground, +Y up
};
constexpr float degrees_a_radian = 57.29577951f;

Bearing bearing_of(glm::vec3 direction) {
  const float level = std::hypot(direction.x, direction.z);
  float compass = std::atan2(direction.x, -direction.z) * degrees_a_radian;
  if (compass < 0) compass += 360;
  return {compass, std::atan2(direction.y, level) * degrees_a_radian};
}

glm::vec3 direction_of(Bearing bearing) {
  const float compass = bearing.compass_deg / degrees_a_radian,
              height = bearing.height_deg / degrees_a_radian;
  return {std::cos(height) * std::sin(compass), std::sin(height), -std::cos(height) * std::cos(compass)};
}

/// Where the light shines as the picture has it, with its edit, in the scene's axes.
glm::vec3 direction_now(const Ui& ui, int index, const stage::LightEdit& edit) {
  const FileFrame& frame = ui.state.display.frame;
  if (edit.direction) return glm::vec3(frame.direction_to_scene(glm::dvec3(*edit.direction)));
  for (const WorldLight& placed : ui.picture ? ui.picture->lights : std::vector<WorldLight>{}) {
    if (placed.light == index) return placed.direction;
  }
  return {0, -1, 0};
}

void edit_direction(Ui& ui, int index, LightType type, stage::LightEdit& edit) {
  const bool sun = type == LightType::directional;
  const float sign = sun ? -1.0f : 1.0f;
  Bearing bearing = bearing_of(sign * direction_now(ui, index, edit));
  row(ui, sun ? "  From" : "  Towards", "Compass: 0 is -Z, 90 is +X. The handle in the view turns it too.");
  bool changed = ImGui::SliderFloat("##compass", &bearing.compass_deg, 0, 360, "%.1f deg");
  ui.mark(fmt::format("light.{}.compass", index));
  row(ui, "  Height",
      sun ? "Height of the sun above the ground." : "Above the ground; below zero it shines down.");
  changed |= ImGui::SliderFloat("##height", &bearing.height_deg, -89.9f, 89.9f, "%.1f deg",
                                ImGuiSliderFlags_AlwaysClamp);
  ui.mark(fmt::format("light.{}.height", index));
  if (!changed) return;
  const glm::dvec3 turned(sign * direction_of(bearing));
  edit.direction = glm::vec3(ui.state.display.frame.direction_to_file(turned));
}

void edit_values(Ui& ui, int index, const Light& light, stage::LightEdit& edit) {
  if (const std::string method = method_of(ui, index); !method.empty() && ui.state.settings.research) {
    row(ui, "  Traced by",
        "The method that found its hard shadows in this picture: the variant, or its replacement.");
    ImGui::TextUnformatted(method.c_str());
  }
  row(ui, "  Colour");
  glm::vec3 color = edit.color.value_or(light.color);
  if (edit_color(ui, fmt::format("light.{}.color", index), color)) edit.color = color;
  row(ui, "  Intensity", "Multiplies the scene's intensity.");
  ImGui::SliderFloat("##intensity", &edit.intensity, 0.01f, 100.0f, "x %.3g", ImGuiSliderFlags_Logarithmic);
  ui.mark(fmt::format("light.{}.intensity", index));
  if (!(edit.intensity > 0)) edit.intensity = 1;
  if (light.type != LightType::point) edit_direction(ui, index, light.type, edit);
  if (light.type == LightType::directional) {
    edit_sun_size(ui, index, light, edit);
    return;
  }
  edit_light_size(ui, index, light, edit);
  row(ui, "  Moved",
      "Offset from its place in the animation, in metres. You can also drag its circle in the view.");
  ImGui::DragFloat3("##move", &edit.move.x, 0.01f * ui.state.fly_speed, 0, 0, "%.2f");
  ui.mark(fmt::format("light.{}.move", index));
}

void edit_light(Ui& ui, int index, const Light& light, bool open) {
  stage::LightEdit edit = stage::edit_of(ui.state.edits.lights, index);
  if (edit.deleted) return;
  const stage::LightEdit before = edit;
  ImGui::PushID(index);
  ImGui::Checkbox("##on", &edit.on);
  ui.mark(fmt::format("light.{}.on", index));
  tooltip("Shines, or is off.");
  ImGui::SameLine(0, ui.px(4));
  const bool selected = ui.state.selected_light == index;
  if (selected && ui.state.shown_light != index) ImGui::SetNextItemOpen(true);
  const std::string title = fmt::format(
      "{}  {}", index, light.name.empty() ? type_name(ui, light, edit) : std::string_view(light.name));
  const int flags = ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_OpenOnArrow |
                    ImGuiTreeNodeFlags_OpenOnDoubleClick | (selected ? ImGuiTreeNodeFlags_Selected : 0) |
                    (open ? ImGuiTreeNodeFlags_DefaultOpen : 0) | ImGuiTreeNodeFlags_AllowItemOverlap;
  const bool is_open = ImGui::TreeNodeEx("light", flags, "%s", title.c_str());
  ui.mark(fmt::format("light.{}.name", index));
  if (ImGui::IsItemClicked()) ui.state.selected_light = index;
  tooltip(std::string(type_name(ui, light, edit)).c_str());
  ImGui::SameLine(ImGui::GetWindowWidth() - ui.px(edit != stage::LightEdit{} ? 128 : 76));
  if (edit != stage::LightEdit{}) {
    if (ImGui::SmallButton("reset")) edit = {};
    ui.mark(fmt::format("light.{}.reset", index));
    ImGui::SameLine(0, ui.px(4));
  }
  if (ImGui::SmallButton("delete")) edit.deleted = true;
  ui.mark(fmt::format("light.{}.delete", index));
  if (is_open) edit_values(ui, index, light, edit);
  ImGui::PopID();
  if (edit != before) ui.state.light_edit(index) = edit;
}

/// With which white at a distance shows as white in the exposure in use: candela or, of suns, lux where the
/// file's lights have units.
float visible_intensity(const Ui& ui, LightType type, float distance_m) {
  if (!ui.state.scene->light_has_units) return 1;
  const float lux = glm::pi<float>() / render_settings(ui.state.method(), {}, ui.state.display).exposure;
  return type == LightType::directional ? lux : lux * distance_m * distance_m;
}

void add_lights(Ui& ui) {
  row(ui, "Add", "A light above what was clicked last, or above the scene.");
  constexpr struct {
    const char* name;
    LightType type;
  } kinds[] = {{"point", LightType::point}, {"spot", LightType::spot}, {"sun", LightType::directional}};
  for (const auto& kind : kinds) {
    if (&kind != kinds) ImGui::SameLine(0, ui.px(4));
    if (ImGui::Button(kind.name)) add_light(ui, kind.type);
    ui.mark(fmt::format("add.{}", kind.name));
  }
}

}  // namespace

void add_light(Ui& ui, LightType type) {
  ViewState& state = ui.state;
  const bool asked = ui.answer && !ui.answer->pixel.background;
  const glm::vec3 below = asked ? glm::vec3(ui.answer->pixel.point) : state.centre;
  const float height_m = (asked ? 0.1f : 0.35f) * state.diagonal_m;
  const glm::vec3 above = below + glm::vec3(0, height_m, 0);
  const FileFrame& frame = state.scene->scene.frame;
  stage::AddedLight light{.type = type, .position = frame.to_file(glm::dvec3(above))};
  if (type == LightType::directional)
    light.direction = glm::vec3(frame.direction_to_file(glm::normalize(glm::dvec3(-0.5, -1, -0.3))));
  light.intensity = visible_intensity(ui, type, height_m);
  state.edits.added.push_back(light);
  state.selected_light = state.light_count() - 1;
  state.light_edit(state.selected_light) = {};
}

void draw_light_section(Ui& ui) {
  if (!ui.state.scene) return;
  ViewState& state = ui.state;
  if (state.selected_light != state.shown_light && state.selected_light >= 0) ImGui::SetNextItemOpen(true);
  if (!section(ui, "Lights", false)) {
    state.shown_light = state.selected_light;
    return;
  }
  ImGui::Checkbox("handles in the view", &state.light_handles);
  ui.mark("circles");
  add_lights(ui);
  const std::vector<Light> unedited =
      stage::lights_of(state.scene->scene, {.added = state.edits.added}, state.scene->light_has_units);
  const int shown = state.selected_light;
  for (int i = 0; i < static_cast<int>(unedited.size()); ++i)
    edit_light(ui, i, unedited[static_cast<std::size_t>(i)], unedited.size() <= 4);
  state.shown_light = shown;
}

}  // namespace tenebra::viewer
