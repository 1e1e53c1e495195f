// The camera, and the comparison of A and B.
#include <fmt/core.h>
#include <algorithm>

#include "window/panels/panels.h"

namespace tenebra::viewer {

namespace {

/// A place in the scene as numbers of its file.
void edit_place(const char* name, const FileFrame& frame, glm::vec3& place) {
  glm::dvec3 numbers = frame.to_file(glm::dvec3(place));
  if (edit_coordinates(name, numbers)) place = glm::vec3(frame.to_scene(numbers));
}

}  // namespace

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
    edit_place("##eye", state.scene->scene.frame, state.free.eye);
    row(ui, "Looks at");
    edit_place("##target", state.scene->scene.frame, state.free.target);
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
