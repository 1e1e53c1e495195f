// The sun of a day: where and when, the light that follows it, hours as colours.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

bool edit_place(Ui& ui, SunDay& day) {
  row(ui, "Place", "Degrees of latitude and longitude, north and east positive.");
  std::array<double, 2> place{day.place.latitude_deg, day.place.longitude_deg};
  const bool changed =
      ImGui::DragScalarN("##place", ImGuiDataType_Double, place.data(), 2, 0.05f, nullptr, nullptr, "%.3f");
  ui.mark("sun.place");
  if (!changed || !std::isfinite(place[0]) || !std::isfinite(place[1])) return false;
  day.place = {std::clamp(place[0], -90.0, 90.0), std::clamp(place[1], -180.0, 180.0)};
  return true;
}

bool edit_day(Ui& ui, SunDay& day) {
  row(ui, "Day", "Year, month, day; the slider goes through the year.");
  std::array<char, 16> text{};
  sun::day_text(day.day).copy(text.data(), text.size() - 1);
  bool changed = false;
  if (ImGui::InputText("##day", text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll))
    if (const auto typed = sun::parse_day(text.data())) day.day = *typed, changed = true;
  ui.mark("sun.day");
  row(ui, "");
  int number = day_of_year(day.day);
  if (ImGui::SliderInt("##year", &number, 1, 366, "day %d of the year", ImGuiSliderFlags_AlwaysClamp))
    day.day = with_day_of_year(day.day, number), changed = true;
  ui.mark("sun.year");
  return changed;
}

bool edit_time(Ui& ui, SunDay& day) {
  row(ui, "Zone", "What the clocks are ahead of UTC, daylight saving included.");
  float ahead_h = static_cast<float>(day.zone_min) / 60;
  bool changed = ImGui::SliderFloat("##zone", &ahead_h, -12, 14, "UTC %+.2f h", ImGuiSliderFlags_AlwaysClamp);
  if (changed) day.zone_min = 15 * static_cast<int>(std::lround(4 * ahead_h));
  ui.mark("sun.zone");
  row(ui, "North", "How far true north is turned from the file's, clockwise seen from above.");
  changed |=
      ImGui::SliderFloat("##north", &day.north_deg, -180, 180, "%.1f deg", ImGuiSliderFlags_AlwaysClamp);
  ui.mark("sun.north");
  row(ui, "Time");
  const std::string clock = fmt::format("{:02}:{:02}", day.minute / 60, day.minute % 60);
  changed |= ImGui::SliderInt("##minute", &day.minute, 0, 24 * 60 - 1, clock.c_str(),
                              ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput);
  ui.mark("sun.minute");
  row(ui, "");
  const sun::Position at = sun_at(day);
  dim_text(at.altitude_deg > 0
               ? fmt::format("azimuth {:.1f}, height {:.1f} deg", at.azimuth_deg, at.altitude_deg).c_str()
               : "below the horizon");
  return changed;
}

/// The selected light, if it is a sun, else the first one; -1: there is none.
int sun_light(const ViewState& state) {
  const auto is_sun = [&](int light) {
    return light >= 0 && light < state.light_count() && state.light_type(light) == LightType::directional &&
           !stage::edit_of(state.edits.lights, light).deleted;
  };
  if (is_sun(state.selected_light)) return state.selected_light;
  for (int light = 0; light < state.light_count(); ++light)
    if (is_sun(light)) return light;
  return -1;
}

/// The way that the day's sun shines, in the file's axes.
glm::vec3 direction_of_day(const ViewState& state) {
  return glm::vec3(state.scene->scene.frame.direction_to_file(-way_to_sun(state.sun)));
}

/// At night it is off; the day switches on what the night has switched off, not the user.
void turn_sun(Ui& ui) {
  if (sun_light(ui.state) < 0) {
    add_light(ui, LightType::directional);
    ui.state.shown_light = ui.state.selected_light;  // the list of lights does not unfold above this section
  }
  const int light = sun_light(ui.state);
  stage::LightEdit& edit = ui.state.light_edit(light);
  int& dark_light = ui.state.sun.dark_light;
  const bool night = way_to_sun(ui.state.sun).y <= 0;
  if (!night && dark_light == light) edit.on = true, dark_light = -1;
  if (night && edit.on) edit.on = false, dark_light = light;
  edit.direction = direction_of_day(ui.state);
}

/// Undone, or turned by hand.
bool stands_elsewhere(const ViewState& state) {
  const int light = sun_light(state);
  return light >= 0 && stage::edit_of(state.edits.lights, light).direction != direction_of_day(state);
}

void draw_counting(Ui& ui) {
  SunDay& day = ui.state.sun;
  row(ui, "Hours",
      "Counts for each pixel how long the sun reaches it on this day; anew for each view. Glass "
      "dims it; curved surfaces count as their flat triangles.");
  ImGui::Checkbox("as colours", &day.colours);
  ui.mark("sun.colours");
  if (!day.colours) return;
  row(ui, "");
  if (ui.sun.running) {
    const float stop_px = ImGui::CalcTextSize("Stop").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float width = ImGui::GetContentRegionAvail().x - stop_px - ImGui::GetStyle().ItemSpacing.x;
    ImGui::ProgressBar(static_cast<float>(ui.sun.done), {width, 0});
    ImGui::SameLine();
    if (ImGui::Button("Stop")) day.colours = false;
    ui.mark("sun.stop");
  } else if (ui.hours) {
    dim_text(
        fmt::format("{:.1f} to {:.1f} h, mean {:.1f}", ui.hours->least_h, ui.hours->most_h, ui.hours->mean_h)
            .c_str());
  } else {
    dim_text("when the view rests");
  }
}

}  // namespace

void draw_sun_section(Ui& ui) {
  if (!ui.state.scene) return;
  SunDay& day = ui.state.sun;
  day.open = section(ui, "Sun of a day", false);
  if (!day.open) return;
  bool changed = edit_place(ui, day);
  changed |= edit_day(ui, day);
  changed |= edit_time(ui, day);
  row(ui, "Light");
  changed |= ImGui::Checkbox("turns with it", &day.moves);
  ui.mark("sun.moves");
  tooltip("The selected sun of the scene, or its first; one is added where there is none.");
  if (changed && day.moves) turn_sun(ui);
  if (day.moves && stands_elsewhere(ui.state)) dim_text("The light is elsewhere; move the time to turn it.");
  draw_counting(ui);
  dim_text("A click says when a place is dark, and why.");
}

}  // namespace tenebra::viewer
