// Where the parts of the window go, the panel that holds the sections, and what shows over the picture while
// something takes long.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

constexpr float panel_px = 344;
constexpr float least_view_px = 280;  // beside the panel, so that a window 640 wide has one
constexpr float transport_px = 74;

}  // namespace

Layout layout_of(const Ui& ui, ImVec2 window) {
  Layout layout;
  layout.has_panel = ui.state.panel && window.x >= ui.px(panel_px + least_view_px);
  const float panel = layout.has_panel ? ui.px(panel_px) : 0;
  const float transport = std::min(ui.px(transport_px), window.y / 2);
  const float width = std::floor(window.x - panel), height = std::floor(window.y - transport);
  layout.view = {{0, 0}, {std::max(1.0f, width), std::max(1.0f, height)}};
  layout.transport = {{0, height}, {width, transport}};
  layout.panel = {{width, 0}, {panel, window.y}};
  return layout;
}

void draw_panel(Ui& ui, Area area) {
  ImGui::SetNextWindowPos(area.low);
  ImGui::SetNextWindowSize(area.size);
  const bool by_keys = ui.state.keys_in_panel;
  const int nav = by_keys ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoNav;
  if (by_keys && !ui.state.panel_has_keys) ImGui::SetNextWindowFocus();
  ui.state.panel_has_keys = by_keys;
  ImGui::Begin("##panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | nav);
  if (by_keys) {
    const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImGui::GetForegroundDrawList()->AddRect(low, {low.x + size.x, low.y + size.y}, palette::accent, 0, 0, 2);
  }
  draw_scene_section(ui);
  draw_method_section(ui);
  draw_light_section(ui);
  draw_sun_section(ui);
  draw_tree_section(ui);
  draw_material_section(ui);
  draw_camera_section(ui);
  draw_compare_section(ui);
  draw_research_section(ui);
  ImGui::End();
}

void draw_progress(Ui& ui, Area view) {
  const WorkerStatus& status = ui.worker;
  const bool first = !ui.picture && status.elapsed_s > 0;
  if ((!status.loading && !status.drawing) || (!status.slow && !first)) return;
  const bool soft = ui.state.method().render.shadows == render::ShadowMode::soft;
  std::string what = status.loading ? "Loading " + std::filesystem::path(status.stage).filename().string()
                     : !status.stage.empty() ? status.stage
                     : soft                  ? "Exact soft shadows"
                                             : "Computing";
  ImGui::SetNextWindowPos({view.low.x + view.size.x / 2, view.low.y + view.size.y - ui.px(48)},
                          ImGuiCond_Always, {0.5f, 1});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::shade);
  ImGui::Begin("##progress", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(fmt::format("{}   {:.1f} s", what, status.elapsed_s).c_str());
  if (status.done > 0) {
    ImGui::SameLine();
    ImGui::ProgressBar(static_cast<float>(status.done), {ui.px(140), 0});
  }
  if (status.drawing) {
    ImGui::SameLine();
    if (ImGui::Button("Cancel (Esc)")) ui.actions.cancel = true;
    ui.mark("cancel");
  }
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace tenebra::viewer
