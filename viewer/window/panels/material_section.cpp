// The materials: their colours and factors.
#include <fmt/core.h>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

std::string material_name(const Scene& scene, int material) {
  const std::string& name = scene.materials[static_cast<std::size_t>(material)].name;
  return name.empty() ? fmt::format("material {}", material) : fmt::format("{}  {}", material, name);
}

/// A colour of the material, the scene's until it is changed.
void color_row(Ui& ui, const char* label, const char* mark, const glm::vec3& own,
               std::optional<glm::vec3>& edit) {
  row(ui, label);
  glm::vec3 color = edit.value_or(own);
  if (edit_color(ui, mark, color)) edit = color;
}

void share_row(Ui& ui, const char* label, const char* mark, float own, std::optional<float>& edit) {
  row(ui, label);
  float value = edit.value_or(own);
  if (ImGui::SliderFloat(fmt::format("##{}", mark).c_str(), &value, 0, 1, "%.2f",
                         ImGuiSliderFlags_AlwaysClamp))
    edit = value;
  ui.mark(mark);
}

void choose_material(Ui& ui) {
  const Scene& scene = ui.state.scene->scene;
  row(ui, "Material", "Click on a surface in the view to see its material.");
  const int chosen = ui.state.selected_material;
  if (ImGui::BeginCombo("##material", chosen < 0 ? "choose one" : material_name(scene, chosen).c_str())) {
    for (int i = 0; i < static_cast<int>(scene.materials.size()); ++i) {
      ImGui::PushID(i);
      if (ImGui::Selectable(material_name(scene, i).c_str(), i == chosen)) ui.state.selected_material = i;
      ui.mark(fmt::format("material.{}", i));
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  ui.mark("material");
}

}  // namespace

void draw_material_section(Ui& ui) {
  if (!ui.state.scene || ui.state.scene->scene.materials.empty()) return;
  if (ui.state.shown_material != ui.state.selected_material && ui.state.selected_material >= 0)
    ImGui::SetNextItemOpen(true);
  ui.state.shown_material = ui.state.selected_material;
  if (!section(ui, "Materials", false)) return;
  choose_material(ui);
  const int number = ui.state.selected_material;
  if (number < 0) return;
  const Material& material = ui.state.scene->scene.materials[static_cast<std::size_t>(number)];
  auto& edits = ui.state.edits.materials;
  const auto found = edits.find(number);
  stage::MaterialEdit edit = found == edits.end() ? stage::MaterialEdit{} : found->second;
  const stage::MaterialEdit before = edit;
  ImGui::PushID(number);
  color_row(ui, "Colour", "material.color", material.base_color, edit.color);
  if (material.base_color_map) dim_text("times the colours of its texture");
  if (material.model == SurfaceModel::phong)
    color_row(ui, "Gloss", "material.specular", material.specular, edit.specular);
  if (material.model == SurfaceModel::metallic_roughness) {
    share_row(ui, "Metallic", "material.metallic", material.metallic, edit.metallic);
    share_row(ui, "Roughness", "material.roughness", material.roughness, edit.roughness);
  }
  color_row(ui, "Shines", "material.emissive", material.emissive, edit.emissive);
  if (edit != stage::MaterialEdit{}) {
    row(ui, "");
    if (ImGui::Button("as in the scene", {-1, 0})) edit = {};
    ui.mark("material.reset");
  }
  ImGui::PopID();
  if (edit == before) return;
  edits[number] = edit;
  if (edit == stage::MaterialEdit{}) edits.erase(number);
}

}  // namespace tenebra::viewer
