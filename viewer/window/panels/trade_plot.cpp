// Which settings are worth their time on the view that is shown: the search, and its points to choose from.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "log/ticks.h"
#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

constexpr ImU32 plot_ground = IM_COL32(13, 14, 18, 255);
constexpr float dot_px = 4.5f, lit_px = dot_px + 5, reach_px = 9;

float label_height() {
  return ImGui::GetFontSize() * 0.85f;
}

/// "4 samples, soft error 2, AO error 1", of what there was to choose.
std::string words_of(const TradeAxes& axes, const TradeSetting& setting) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto error = [](double value) { return value > 0 ? fmt::format("error {:g}", value) : "exact"; };
  if (axes.antialias.size() > 1)
    add(fmt::format("{} sample{}", setting.antialias, setting.antialias == 1 ? "" : "s"));
  if (axes.soft_errors.size() > 1) add("soft " + error(setting.soft_error));
  if (axes.ao_errors.size() > 1) add("AO " + error(setting.ao_error));
  return text;
}

/// Time, on a logarithmic scale, and error as places in the plot; above and below lies a line of text that no
/// point, lit or not, touches.
struct PlotScale {
  ImVec2 low, size, margin;
  double first_ms = HUGE_VAL, last_ms = 0, highest = 0.1;

  PlotScale(const TradeResult& result, ImVec2 at, ImVec2 whole, ImVec2 around)
      : low(at), size(whole), margin(around) {
    for (const TradedSetting& setting : result.measured) {
      first_ms = std::min(first_ms, setting.point.ms);
      last_ms = std::max(last_ms, setting.point.ms);
      highest = std::max(highest, setting.point.error);
    }
    first_ms = std::max(first_ms, 1e-3) / 1.2, last_ms = std::max(last_ms, first_ms) * 1.2;
  }
  ImVec2 at(const TradePoint& point) const {
    const double x = std::log(std::max(point.ms, 1e-3) / first_ms) / std::log(last_ms / first_ms),
                 y = 1 - point.error / highest;
    return {low.x + margin.x + (size.x - 2 * margin.x) * static_cast<float>(x),
            low.y + margin.y + (size.y - 2 * margin.y) * static_cast<float>(y)};
  }
};

bool is_chosen(const Ui& ui, const TradeAxes& axes, const TradeSetting& setting) {
  const render::RenderSettings now = ui.state.slots[static_cast<std::size_t>(ui.state.active)].render;
  const render::RenderSettings then = with_setting(now, axes, setting);
  return then.antialias == now.antialias && then.soft.error_255 == now.soft.error_255 &&
         then.ao.error_255 == now.ao.error_255;
}

/// The point under the hand, -1: none.
int point_under(const Ui& ui, const TradeResult& result, const PlotScale& scale) {
  if (!ImGui::IsItemHovered()) return -1;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  int nearest = -1;
  float least = ui.px(reach_px);
  for (std::size_t i = 0; i < result.measured.size(); ++i) {
    const ImVec2 at = scale.at(result.measured[i].point);
    const float distance = std::hypot(at.x - mouse.x, at.y - mouse.y);
    if (distance < least) least = distance, nearest = static_cast<int>(i);
  }
  return nearest;
}

void draw_scale(Ui& ui, const PlotScale& scale) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end{scale.low.x + scale.size.x, scale.low.y + scale.size.y};
  list.AddRectFilled(scale.low, end, plot_ground, 3);
  const float font = label_height();
  const float top = scale.at({{}, scale.first_ms, scale.highest}).y;
  list.AddLine({scale.low.x, top}, {end.x, top}, palette::line);
  for (const double ms : logarithmic_ticks(scale.first_ms, scale.last_ms)) {
    const float x = scale.at({{}, ms, 0}).x;
    list.AddLine({x, top}, {x, end.y}, palette::line);
    list.AddText(nullptr, font, {x + ui.px(2), end.y - font - ui.px(2)}, palette::dim,
                 fmt::format("{:g}", ms).c_str());
  }
  const std::string label = fmt::format("error {:.2g}/255; below: ms per frame", scale.highest);
  const ImVec2 at{scale.low.x + ui.px(4), scale.low.y + ui.px(1)};
  list.AddText(nullptr, font, at, palette::dim, label.c_str());
  const float width = ImGui::GetFont()->CalcTextSizeA(font, FLT_MAX, 0, label.c_str()).x;
  ui.marks["trade.label"] = {at.x, at.y, at.x + width, at.y + font};
}

/// `lit`: the point that the hand or the keyboard is at; -1: none.
void draw_points(const Ui& ui, const TradeResult& result, const PlotScale& scale, int lit) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t i = 1; i < result.front.size(); ++i)
    list.AddLine(scale.at(result.measured[result.front[i - 1]].point),
                 scale.at(result.measured[result.front[i]].point), palette::accent, 1.5f);
  for (std::size_t i = 0; i < result.measured.size(); ++i) {
    const TradePoint& point = result.measured[i].point;
    const ImVec2 at = scale.at(point);
    const bool front = std::find(result.front.begin(), result.front.end(), i) != result.front.end();
    if (front)
      list.AddCircleFilled(at, ui.px(dot_px), palette::accent);
    else
      list.AddCircle(at, ui.px(dot_px), palette::dim, 0, 1.5f);
    const bool below = at.y - ImGui::GetFontSize() < scale.low.y + label_height() + ui.px(2);
    if (point.setting == standard(result.axes))
      list.AddText(nullptr, label_height(),
                   {at.x + ui.px(7), below ? at.y + ui.px(2) : at.y - ImGui::GetFontSize()}, palette::warning,
                   "standard");
    if (is_chosen(ui, result.axes, point.setting))
      list.AddCircle(at, ui.px(dot_px + 3), palette::text, 0, 1.5f);
    if (static_cast<int>(i) == lit) list.AddCircle(at, ui.px(lit_px), palette::warning, 0, 2);
  }
}

void apply(Ui& ui, const TradeResult& result, int i) {
  render::RenderSettings& render = ui.state.method().render;
  render = with_setting(render, result.axes, result.measured[static_cast<std::size_t>(i)].point.setting);
}

/// The points as rows, for the keyboard; the row that is lit, -1: none.
int draw_rows(Ui& ui, const TradeResult& result) {
  int lit = -1;
  for (std::size_t i = 0; i < result.measured.size(); ++i) {
    const TradePoint& point = result.measured[i].point;
    const bool usual = point.setting == standard(result.axes);
    const std::string text =
        fmt::format("{:.{}f} ms   {:.2f}   {}{}##trade{}", point.ms, point.ms < 100 ? 1 : 0, point.error,
                    words_of(result.axes, point.setting), usual ? "  (standard)" : "", i);
    if (ImGui::Selectable(text.c_str(), is_chosen(ui, result.axes, point.setting)))
      apply(ui, result, static_cast<int>(i));
    ui.mark(fmt::format("trade.row.{}", i));
    if (ImGui::IsItemHovered() || (ui.state.keys_in_panel && ImGui::IsItemFocused()))
      lit = static_cast<int>(i);
  }
  return lit;
}

void draw_result(Ui& ui, const FoundTrade& found) {
  const TradeResult& result = found.result;
  if (result.measured.empty()) return;
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, ui.px(170)};
  ImGui::InvisibleButton("##trade plot", size);
  ui.mark("trade.plot");
  const PlotScale scale(result, at, size, {ui.px(15), label_height() + ui.px(lit_px + 3)});
  const bool clicked = ImGui::IsItemClicked();
  int lit = point_under(ui, result, scale);
  if (lit >= 0) {
    const TradedSetting& setting = result.measured[static_cast<std::size_t>(lit)];
    tooltip(fmt::format("{}\n"
                        "{:.1f} ms per frame, off by {:.2f}/255 (RMS). Click: use it",
                        words_of(result.axes, setting.point.setting), setting.point.ms, setting.point.error)
                .c_str());
    if (clicked) apply(ui, result, lit);
  }
  for (std::size_t i = 0; i < result.measured.size() && ImGui::IsItemVisible(); ++i) {
    const ImVec2 dot = scale.at(result.measured[i].point);
    ui.marks[fmt::format("trade.point.{}", i)] = {dot.x - 1, dot.y - 1, dot.x + 1, dot.y + 1};
  }
  draw_scale(ui, scale);
  const int row = draw_rows(ui, result);
  draw_points(ui, result, scale, lit >= 0 ? lit : row);
  if (found.subject != ui.trade_subject)
    dim_text("Measured for another view, time or method than the present one.");
}

}  // namespace

void draw_trade_plot(Ui& ui) {
  const TradeStatus& status = ui.trade;
  if (status.running) {
    const float stop_px = ImGui::CalcTextSize("Stop (Y)").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float width = ImGui::GetContentRegionAvail().x - stop_px - ImGui::GetStyle().ItemSpacing.x;
    ImGui::ProgressBar(static_cast<float>(status.done), {width, 0},
                       fmt::format("trying settings, {:.0f} s", status.elapsed_s).c_str());
    ImGui::SameLine();
    if (ImGui::Button("Stop (Y)")) ui.actions.trade = true;
    ui.mark("trade.stop");
  } else {
    if (ImGui::Button("Try settings on this scene (Y)", {-1, 0})) ui.actions.trade = true;
    ui.mark("trade.start");
    tooltip(
        "Draws the present view with other samples per pixel and other errors, and shows how long each takes "
        "and how far its picture is from the finest. Draw nothing else meanwhile, or the times will be too "
        "long.");
  }
  if (status.found) draw_result(ui, *status.found);
}

}  // namespace tenebra::viewer
