// Why is it dark? The answer about a pixel: a card of words, and lines in the view.
#include <fmt/core.h>

#include "window/panels/stage.h"

namespace tenebra::viewer {
namespace {

using render::LightExplanation;
using shadow::LightSight;

constexpr ImU32 free_way = IM_COL32(255, 226, 130, 255);
constexpr ImU32 blocked_way = IM_COL32(255, 116, 84, 255);
constexpr float card_px = 380;

void outline(const Ui& ui, const Stage& stage, const TriangleCorners& corners, ImU32 color) {
  for (std::size_t k = 0; k < 3; ++k) draw_line(ui, stage, corners[k], corners[(k + 1) % 3], color, 2);
}

glm::dvec3 end_of(const Ui& ui, const PictureAnswer& answer, const LightExplanation& light) {
  if (!light.directional) return light.light_at;
  return answer.pixel.point +
         glm::normalize(glm::dvec3(light.light_at)) * static_cast<double>(ui.state.diagonal_m);
}

ImU32 faint(ImU32 color) {
  return (color & 0x00ffffffu) | IM_COL32(0, 0, 0, 90);
}

std::string material_name(const ViewState& state, int material) {
  const std::string& name = state.scene->scene.materials[static_cast<std::size_t>(material)].name;
  return name.empty() ? fmt::format("material {}", material) : name;
}

std::string verdict(const LightExplanation& light) {
  if (light.visible_fraction && *light.visible_fraction > 0 && *light.visible_fraction < 1)
    return fmt::format("{:.0f} % of it is seen", 100 * *light.visible_fraction);
  switch (light.sight) {
    case LightSight::lit:
      return light.faces_shading ? "shines here" : "is behind this curved surface";
    case LightSight::faces_away:
      return "is behind this surface";
    case LightSight::out_of_reach:
      return "does not reach this far";
    case LightSight::blocked:
      return "is blocked";
  }
  return "";
}

void light_row(Ui& ui, const PictureAnswer& answer, const LightExplanation& light) {
  const bool lit = light.sight == LightSight::lit && light.faces_shading;
  const float line_height = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddCircleFilled(at + ImVec2(line_height * 0.4f, line_height * 0.55f),
                                              line_height * 0.28f, lit ? free_way : blocked_way);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line_height * 1.1f);
  const std::string name = light.name.empty() ? fmt::format("light {}", light.number)
                                              : fmt::format("{} {}", light.number, light.name);
  if (link(ui, name, fmt::format("why.light.{}", light.number))) ui.state.selected_light = light.number;
  ImGui::SameLine();
  ImGui::TextUnformatted(verdict(light).c_str());
  if (!light.occluder) return;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line_height * 1.1f);
  dim_text(lit ? "mostly behind" : "by");
  ImGui::SameLine();
  if (link(ui, node_name(ui.state, light.occluder->node), fmt::format("why.occluder.{}", light.number)))
    ui.state.selected_node = light.occluder->node;
  std::string more = fmt::format("triangle {}, {:.3g} m away", light.occluder->triangle,
                                 glm::distance(light.met_at, answer.pixel.point));
  if (light.asked > 1) {
    more += fmt::format(", {} of {} sightlines", light.held_by_it, light.asked);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line_height * 1.1f);
  } else {
    ImGui::SameLine();
  }
  dim_text(more.c_str());
}

void draw_words(Ui& ui, const PictureAnswer& answer) {
  const render::PixelExplanation& pixel = answer.pixel;
  const glm::ivec2 at = pixel_at(answer.question.place, answer.question.picture->whole);
  ImGui::TextUnformatted(fmt::format("Pixel {}, {}", at.x, at.y).c_str());
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize("close (Esc)").x - ui.px(12));
  if (link(ui, "close (Esc)", "why.close")) ui.actions.end_explanation = true;
  if (pixel.background) return dim_text("Nothing is seen here but the background.");
  if (link(ui, node_name(ui.state, pixel.seen.node), "why.node")) ui.state.selected_node = pixel.seen.node;
  ImGui::SameLine();
  dim_text(fmt::format("triangle {}", pixel.seen.triangle).c_str());
  ImGui::SameLine();
  if (link(ui, material_name(ui.state, pixel.seen.material), "why.material"))
    ui.state.selected_material = pixel.seen.material;
  ImGui::Separator();
  if (pixel.lights.empty()) dim_text("No light is on.");
  for (const LightExplanation& light : pixel.lights) light_row(ui, answer, light);
  if (answer.question.picture->evidence.settings.shadows == render::ShadowMode::none)
    dim_text("Shadows are off: the picture lights it all the same.");
  draw_day(ui, answer);
}

}  // namespace

void draw_line(const Ui& ui, const Stage& stage, glm::dvec3 a, glm::dvec3 b, ImU32 color, float thickness) {
  const ViewRays& view = ui.picture->view;
  glm::dvec3 from = pixel_of(view, a), to = pixel_of(view, b);
  constexpr double nearest = 1e-3;  // in units of the distance to the picture's plane
  if (from.z < nearest && to.z < nearest) return;
  if (!view.orthographic && (from.z < nearest || to.z < nearest)) {
    const glm::dvec3 cut = a + (b - a) * ((nearest - from.z) / (to.z - from.z));
    (from.z < nearest ? from : to) = pixel_of(view, cut);
  }
  for (int place = 0; place < stage.places(); ++place) {
    ImGui::GetWindowDrawList()->AddLine(stage.at_pixel(from, place), stage.at_pixel(to, place), color,
                                        thickness);
  }
}

std::string node_name(const ViewState& state, int node) {
  if (node < 0) return "no node";
  const Scene& scene = state.scene->scene;
  const Node& found = scene.nodes[static_cast<std::size_t>(node)];
  if (!found.name.empty()) return found.name;
  const std::string& mesh = scene.meshes[static_cast<std::size_t>(found.mesh)].name;
  return mesh.empty() ? fmt::format("node {}", node) : mesh;
}

bool link(Ui& ui, const std::string& text, const std::string& mark) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette::accent);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ui.mark(mark);
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  return ImGui::IsItemClicked();
}

void draw_explanation_lines(Ui& ui, const Stage& stage) {
  if (!ui.answer || ui.answer->pixel.background) return;
  const PictureAnswer& answer = *ui.answer;
  outline(ui, stage, answer.seen, palette::accent);
  for (std::size_t i = 0; i < answer.pixel.lights.size(); ++i) {
    const LightExplanation& light = answer.pixel.lights[i];
    const glm::dvec3 end = end_of(ui, answer, light);
    if (light.occluder) {
      outline(ui, stage, answer.occluders[i], blocked_way);
      draw_line(ui, stage, answer.pixel.point, light.met_at, blocked_way, 2);
      draw_line(ui, stage, light.met_at, end, faint(blocked_way), 1.5f);
    } else if (light.sight == LightSight::lit) {
      draw_line(ui, stage, answer.pixel.point, end, free_way, 1.5f);
    }
  }
  const glm::dvec3 pixel = pixel_of(ui.picture->view, answer.pixel.point);
  if (!(pixel.z > 0)) return;
  for (int place = 0; place < stage.places(); ++place) {
    const ImVec2 at = stage.at_pixel(pixel, place);
    ImGui::GetWindowDrawList()->AddCircleFilled(at, ui.px(4), palette::text);
    ImGui::GetWindowDrawList()->AddCircle(at, ui.px(4), IM_COL32(0, 0, 0, 255));
  }
}

void draw_explanation_card(Ui& ui, Area view) {
  if (!ui.answer || !ui.state.scene || ui.answer->question.picture->scene != ui.state.scene) return;
  const float width = std::min(ui.px(card_px), view.size.x - ui.px(20));
  ImGui::SetNextWindowPos({view.low.x + view.size.x - ui.px(10), view.low.y + view.size.y - ui.px(10)},
                          ImGuiCond_Always, {1, 1});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, std::max(ui.px(80), view.size.y - ui.px(20))});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::shade);
  ImGui::Begin("##why", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav);
  draw_words(ui, *ui.answer);
  const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ui.marks["why"] = {low.x, low.y, low.x + size.x, low.y + size.y};
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace tenebra::viewer
