// The sun's way over the model, and what the colours of its hours mean.
#include <fmt/core.h>

#include "sun/colour_scale.h"
#include "window/panels/stage.h"

namespace tenebra::viewer {
namespace {

constexpr ImU32 path_colour = IM_COL32(255, 206, 92, 200), sun_colour = IM_COL32(255, 226, 130, 255);

/// Where a sun is drawn: on a sphere around the model.
glm::dvec3 on_sky(const ViewState& state, const glm::dvec3& way) {
  return glm::dvec3(state.centre) + 0.5 * static_cast<double>(state.diagonal_m) * way;
}

void dot(const Ui& ui, const Stage& stage, const glm::dvec3& at, float radius, ImU32 colour,
         const char* text) {
  const glm::dvec3 pixel = pixel_of(ui.picture->view, at);
  if (!(pixel.z > 0)) return;
  for (int place = 0; place < stage.places(); ++place) {
    const ImVec2 here = stage.at_pixel(pixel, place);
    ImGui::GetWindowDrawList()->AddCircleFilled(here, ui.px(radius), colour);
    ImGui::GetWindowDrawList()->AddText(here + ImVec2(ui.px(radius + 2), -ui.px(7)), colour, text);
  }
}

}  // namespace

void draw_sun_path(Ui& ui, const Stage& stage) {
  const SunDay& day = ui.state.sun;
  if (!day.open || !ui.state.panel || ui.picture->scene != ui.state.scene) return;
  SunDay at = day;
  constexpr int step_min = 10;
  bool was_up = false;
  glm::dvec3 before(0.0);
  for (at.minute = 0; at.minute <= 24 * 60; at.minute += step_min) {
    const glm::dvec3 way = way_to_sun(at);
    const bool up = way.y > 0;
    if (up && was_up) draw_line(ui, stage, on_sky(ui.state, before), on_sky(ui.state, way), path_colour, 2);
    if (up && at.minute % 60 == 0)
      dot(ui, stage, on_sky(ui.state, way), 2.5f, path_colour,
          at.minute % 180 == 0 ? fmt::format("{}", at.minute / 60).c_str() : "");
    was_up = up, before = way;
  }
  const glm::dvec3 now = way_to_sun(day);
  if (now.y <= 0) return;
  draw_line(ui, stage, glm::dvec3(ui.state.centre), on_sky(ui.state, now), IM_COL32(255, 226, 130, 110),
            1.5f);
  dot(ui, stage, on_sky(ui.state, now), 8, sun_colour, "");
}

void draw_hours_legend(Ui& ui, const Area& place) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const CountedSun& hours = *ui.hours;
  const float width = std::min(ui.px(220), place.size.x - ui.px(16)), bar_px = width - ui.px(20);
  const ImVec2 low = place.low + ImVec2(place.size.x - width - ui.px(8), ui.px(8));
  list.AddRectFilled(low, low + ImVec2(width, ui.px(62)), palette::shade, 3);
  const ImVec2 bar = low + ImVec2(ui.px(10), ui.px(26));
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const glm::vec3 c = 255.0f * sun::ColourScale{1}((i + 0.5) / steps) + 0.5f;
    const float left = bar.x + bar_px * static_cast<float>(i) / steps,
                right = bar.x + bar_px * static_cast<float>(i + 1) / steps;
    list.AddRectFilled({left, bar.y}, {right, bar.y + ui.px(12)},
                       IM_COL32(static_cast<int>(c.r), static_cast<int>(c.g), static_cast<int>(c.b), 255));
  }
  list.AddText(low + ImVec2(ui.px(10), ui.px(5)), palette::text,
               fmt::format("hours of sun, {}", sun::day_text(hours.asked.day.day)).c_str());
  list.AddText(bar + ImVec2(0, ui.px(14)), palette::dim, "0");
  const std::string right = fmt::format("{:.1f} h", hours.most_h);
  list.AddText(bar + ImVec2(bar_px - ImGui::CalcTextSize(right.c_str()).x, ui.px(14)), palette::dim,
               right.c_str());
  ui.marks["sun.legend"] = {low.x, low.y, low.x + width, low.y + ui.px(62)};
}

}  // namespace tenebra::viewer
