// The lights, the camera, and the comparison of A and B.
#include <fmt/core.h>
#include <algorithm>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

const char* type_name(LightType type) {
  constexpr const char* names[] = {"point", "spot", "directional", "rectangle", "disk"};
  return names[static_cast<std::size_t>(type)];
}

/// Width and height of a light where the user has not changed them: the scene's, of a point the method's; 0:
/// none.
glm::vec2 size_without_edit_m(const Ui& ui, int index, const Light& light) {
  if (light.type == LightType::point || light.type == LightType::spot) {
    const LightSize size = ui.state.method().light_size.value_or(LightSize{});
    return size.size * (size.percent ? 0.01f * ui.state.diagonal_m : 1.0f);
  }
  for (const WorldLight& placed : ui.picture ? ui.picture->lights : std::vector<WorldLight>{}) {
    if (placed.light == index)
      return 2.0f * glm::vec2(glm::length(placed.axis_x), glm::length(placed.axis_y));
  }
  return light.size_m;
}

void edit_light_size(Ui& ui, int index, const Light& light, LightEdit& edit) {
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

void edit_light(Ui& ui, int index, const Light& light) {
  LightEdit edit = edit_of(ui.state.edits.lights, index);
  const LightEdit before = edit;
  ImGui::PushID(index);
  const std::string title =
      fmt::format("{}  {}", index, light.name.empty() ? type_name(light.type) : light.name.c_str());
  ImGui::Checkbox(title.c_str(), &edit.on);
  ui.mark(fmt::format("light.{}.on", index));
  tooltip(type_name(light.type));
  if (edit != LightEdit{}) {
    ImGui::SameLine(ImGui::GetWindowWidth() - ui.px(64));
    if (ImGui::SmallButton("reset")) edit = {};
    ui.mark(fmt::format("light.{}.reset", index));
  }
  if (const std::string method = method_of(ui, index); !method.empty()) {
    row(ui, "  Traced by",
        "What found its hard shadows in this picture: the variant, or what took its place.");
    ImGui::TextUnformatted(method.c_str());
  }
  row(ui, "  Intensity", "Multiplies the scene's intensity.");
  ImGui::SliderFloat("##intensity", &edit.intensity, 0.01f, 100.0f, "x %.3g", ImGuiSliderFlags_Logarithmic);
  ui.mark(fmt::format("light.{}.intensity", index));
  if (!(edit.intensity > 0)) edit.intensity = 1;
  if (light.type != LightType::directional) {
    edit_light_size(ui, index, light, edit);
    row(ui, "  Moved",
        "Away from where the animation has it, in metres. You can also drag its circle in the view.");
    ImGui::DragFloat3("##move", &edit.move.x, 0.02f, 0, 0, "%.2f");
  }
  ImGui::PopID();
  if (edit != before) ui.state.light_edit(index) = edit;
}

}  // namespace

void draw_light_section(Ui& ui) {
  if (!ui.state.scene || !section(ui, "Lights", false)) return;
  const auto& lights = ui.state.scene->scene.lights;
  ImGui::Checkbox("circles in the view", &ui.state.light_handles);
  ui.mark("circles");
  for (int i = 0; i < static_cast<int>(lights.size()); ++i)
    edit_light(ui, i, lights[static_cast<std::size_t>(i)]);
}

void draw_camera_section(Ui& ui) {
  if (!ui.state.scene || !section(ui, "Camera", false)) return;
  ViewState& state = ui.state;
  constexpr const char* modes[] = {"scene", "orbit", "fly"};
  row(ui, "Moves", "The scene's animated camera, one that orbits a point, or one that flies (W A S D Q E).");
  int mode = static_cast<int>(state.camera_mode);
  if (segments(ui, "camera", modes, 3, mode)) leave_scene_camera(ui, static_cast<CameraMode>(mode));
  const auto& cameras = state.scene->scene.cameras;
  if (cameras.size() > 1 && state.camera_mode == CameraMode::scene) {
    row(ui, "Camera");
    const auto name = [&](int i) {
      const std::string& own = cameras[static_cast<std::size_t>(i)].name;
      return own.empty() ? fmt::format("camera {}", i) : own;
    };
    if (ImGui::BeginCombo("##camera", name(state.camera).c_str())) {
      for (int i = 0; i < static_cast<int>(cameras.size()); ++i) {
        ImGui::PushID(i);
        if (ImGui::Selectable(name(i).c_str(), i == state.camera)) state.camera = i;
        ImGui::PopID();
      }
      ImGui::EndCombo();
    }
  }
  if (state.camera_mode != CameraMode::scene) {
    row(ui, "Eye");
    ImGui::DragFloat3("##eye", &state.free.eye.x, 0.05f, 0, 0, "%.3f");
    row(ui, "Looks at");
    ImGui::DragFloat3("##target", &state.free.target.x, 0.05f, 0, 0, "%.3f");
    row(ui, "Field of view");
    float fov = static_cast<float>(state.free.fov_deg);
    if (ImGui::SliderFloat("##fov", &fov, 5, 150, "%.1f degrees"))
      state.free.fov_deg = std::clamp(fov, 1.0f, 179.0f);
    if (state.camera_mode == CameraMode::fly) {
      row(ui, "Speed");
      ImGui::SliderFloat("##fly", &state.fly_speed, 1e-3f * state.diagonal_m, state.diagonal_m, "%.2f m/s",
                         ImGuiSliderFlags_Logarithmic);
    }
  }
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Reset", {half, 0})) {
    state.reset_camera();
  }
  ui.mark("reset camera");
  ImGui::SameLine();
  if (ImGui::Button("Copy arguments", {half, 0})) ui.actions.copy_arguments = true;
  ui.mark("copy arguments");
  tooltip("Copies camera, method and lights to the clipboard, as options of tenebra render (Ctrl+C).");
}

void draw_compare_section(Ui& ui) {
  if (!section(ui, "Compare", ui.state.compare)) return;
  ViewState& state = ui.state;
  row(ui, "A with B", "Draws both methods; X flips.");
  ImGui::Checkbox("draw both##compare", &state.compare);
  ui.mark("compare");
  if (!state.compare) return;
  constexpr const char* views[] = {"A", "B", "side", "wipe", "diff"};
  int show = static_cast<int>(state.show);
  if (segments(ui, "show", views, 5, show)) state.show = static_cast<CompareView>(show);
  if (state.show == CompareView::wipe) {
    row(ui, "Wipe");
    ImGui::SliderFloat("##wipe", &state.wipe, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    ui.mark("wipe slider");
  }
  if (state.show == CompareView::difference) {
    row(ui, "Brighter by", "Multiplies the difference that is shown.");
    ImGui::SliderInt("##gain", &state.gain, 1, 64, "%d",
                     ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  }
  if (!ui.picture || !ui.picture->b) return;
  const PictureDifference& difference = ui.picture->difference;
  row(ui, "Difference");
  if (difference.differing == 0) {
    ImGui::TextUnformatted("none: the same picture");
  } else {
    ImGui::TextUnformatted(
        fmt::format("{} pixels, most {}", difference.differing, difference.largest).c_str());
    tooltip(fmt::format(
                "{:.2f} % of the pixels differ; the largest difference of a channel is {} of 255.",
                100.0 * static_cast<double>(difference.differing) / static_cast<double>(difference.pixels),
                difference.largest)
                .c_str());
  }
}

}  // namespace tenebra::viewer
