// A pixel's day: a bar for each sun that stands above the horizon, lit or dark, and who blocks how much.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

using render::LightExplanation;

constexpr ImU32 night_colour = IM_COL32(13, 14, 18, 255), lit_colour = IM_COL32(255, 226, 130, 255),
                away_colour = IM_COL32(92, 97, 110, 255);
constexpr std::array<ImU32, 4> blocker_colours{IM_COL32(255, 116, 84, 255), IM_COL32(94, 156, 255, 255),
                                               IM_COL32(198, 120, 221, 255), IM_COL32(86, 182, 140, 255)};
constexpr ImU32 others_colour = IM_COL32(150, 90, 70, 255);

bool reaches(const LightExplanation& sun) {
  return sun.sight == shadow::LightSight::lit && sun.faces_shading;
}
/// -1: nothing blocks it.
int blocker_of(const LightExplanation& sun) {
  return sun.sight == shadow::LightSight::blocked && sun.occluder ? sun.occluder->node : -1;
}

struct Blocker {
  int node;
  double minutes;
};
/// The longest first; of equals the smaller node.
std::vector<Blocker> blockers_of(const PictureAnswer& answer) {
  std::map<int, double> minutes;
  for (std::size_t i = 0; i < answer.day.size(); ++i)
    if (const int node = blocker_of(answer.day[i]); node >= 0)
      minutes[node] += answer.question.suns->list[i].weight;
  std::vector<Blocker> out;
  for (const auto& [node, sum] : minutes) out.push_back({node, sum});
  std::stable_sort(out.begin(), out.end(),
                   [](const Blocker& a, const Blocker& b) { return a.minutes > b.minutes; });
  return out;
}

ImU32 colour_of(const LightExplanation& sun, const std::vector<Blocker>& blockers) {
  if (reaches(sun)) return lit_colour;
  const int node = blocker_of(sun);
  if (node < 0) return away_colour;
  for (std::size_t i = 0; i < blockers.size() && i < blocker_colours.size(); ++i)
    if (blockers[i].node == node) return blocker_colours[i];
  return others_colour;
}

std::string sight_words(const Ui& ui, const LightExplanation& sun) {
  if (reaches(sun)) return "the sun shines here";
  const int node = blocker_of(sun);
  return node < 0 ? "the sun is behind this surface" : "blocked by " + node_name(ui.state, node);
}

std::string length_of(double minutes) {
  const int whole = static_cast<int>(std::lround(minutes));
  return whole < 60 ? fmt::format("{} min", whole) : fmt::format("{} h {:02} min", whole / 60, whole % 60);
}

/// Of the day, by the zone's clocks.
double minute_of(const sun::Suns& suns, const sun::Sun& at) {
  const double minutes = at.utc_s / 60 + suns.zone_min;
  return minutes - 1440 * std::floor(minutes / 1440);
}

void draw_bars(Ui& ui, const PictureAnswer& answer, const std::vector<Blocker>& blockers) {
  const sun::Suns& suns = *answer.question.suns;
  const float font = ImGui::GetFontSize() * 0.85f, height = ui.px(26);
  const ImVec2 low = ImGui::GetCursorScreenPos(),
               size{ImGui::GetContentRegionAvail().x, height + font + ui.px(3)};
  ImGui::InvisibleButton("##day chart", size);
  ui.mark("why.day");
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto x_at = [&](double minute) { return low.x + size.x * static_cast<float>(minute / 1440); };
  list.AddRectFilled(low, {low.x + size.x, low.y + height}, night_colour);
  for (std::size_t i = 0; i < answer.day.size(); ++i) {
    const double minute = minute_of(suns, suns.list[i]), half = suns.list[i].weight / 2;
    const float left = x_at(minute - half), right = x_at(minute + half);
    list.AddRectFilled({left, low.y}, {right, low.y + height}, colour_of(answer.day[i], blockers));
    const float mouse = ImGui::GetIO().MousePos.x;
    if (hovered && mouse >= left && mouse < right)
      tooltip(fmt::format("{} to {}: {}",
                          sun::time_text(suns.list[i].utc_s - 60 * half, suns.zone_min).substr(11, 5),
                          sun::time_text(suns.list[i].utc_s + 60 * half, suns.zone_min).substr(11, 5),
                          sight_words(ui, answer.day[i]))
                  .c_str());
  }
  for (int hour = 0; hour <= 24; hour += 3) {
    const std::string text = fmt::format("{}", hour);
    const float width = ImGui::GetFont()->CalcTextSizeA(font, FLT_MAX, 0, text.c_str()).x;
    const float x = std::clamp(x_at(60 * hour) - width / 2, low.x, low.x + size.x - width);
    list.AddText(nullptr, font, {x, low.y + height + ui.px(2)}, palette::dim, text.c_str());
  }
  const float now = x_at(ui.state.sun.minute);
  list.AddLine({now, low.y}, {now, low.y + height}, palette::text, 1.5f);
}

}  // namespace

void draw_day(Ui& ui, const PictureAnswer& answer) {
  if (answer.day.empty()) return;
  const std::vector<Blocker> blockers = blockers_of(answer);
  double lit = 0, day = 0;
  for (std::size_t i = 0; i < answer.day.size(); ++i) {
    const double weight = answer.question.suns->list[i].weight;
    day += weight, lit += reaches(answer.day[i]) ? weight : 0;
  }
  ImGui::Separator();
  ImGui::TextUnformatted(fmt::format("{} of sun, of {}", length_of(lit), length_of(day)).c_str());
  draw_bars(ui, answer, blockers);
  for (std::size_t i = 0; i < blockers.size() && i < blocker_colours.size(); ++i) {
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + line * 0.2f}, {at.x + line * 0.7f, at.y + line * 0.9f}, blocker_colours[i], 2);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line * 1.1f);
    if (link(ui, node_name(ui.state, blockers[i].node), fmt::format("why.day.blocker.{}", i)))
      ui.state.selected_node = blockers[i].node;
    ImGui::SameLine();
    dim_text(("blocks " + length_of(blockers[i].minutes)).c_str());
  }
  if (blockers.size() > blocker_colours.size())
    dim_text(fmt::format("and {} more", blockers.size() - blocker_colours.size()).c_str());
}

}  // namespace tenebra::viewer
