// What the frames cost: times as a graph, stages, counts, and pictures of where the work is.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

/// A colour for each stage, told apart on dark ground; neighbours differ in brightness too.
constexpr std::array stage_colors{
    IM_COL32(110, 118, 134, 255), IM_COL32(94, 156, 255, 255), IM_COL32(58, 96, 168, 255),
    IM_COL32(120, 210, 220, 255), IM_COL32(150, 110, 70, 255), IM_COL32(222, 170, 90, 255),
    IM_COL32(122, 196, 120, 255), IM_COL32(70, 140, 76, 255),  IM_COL32(190, 220, 110, 255),
    IM_COL32(236, 110, 84, 255),  IM_COL32(150, 96, 190, 255), IM_COL32(198, 150, 230, 255),
    IM_COL32(226, 96, 150, 255),  IM_COL32(150, 60, 110, 255), IM_COL32(180, 186, 196, 255),
    IM_COL32(84, 92, 108, 255),   IM_COL32(64, 150, 170, 255), IM_COL32(140, 200, 190, 255),
    IM_COL32(214, 196, 140, 255)};
static_assert(stage_colors.size() == render::frame_stages.size());

constexpr ImU32 ground = IM_COL32(13, 14, 18, 255);  // of the graph

std::string milliseconds(double ms) {
  return fmt::format("{:.{}f}", ms, ms < 10 ? 2 : ms < 100 ? 1 : 0);
}

/// A round number not below `value`: what the axis ends at.
double axis_end(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0}) {
    if (factor * decade >= value) return factor * decade;
  }
  return 10 * decade;
}

void draw_marks_of(const base::Summary& summary, ImVec2 low, ImVec2 size, double top_ms, float font) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const struct {
    const char* name;
    double ms;
    ImU32 color;
  } lines[] = {{"50", summary.median, IM_COL32(255, 255, 255, 190)},
               {"95", summary.percentile_95, IM_COL32(255, 220, 120, 150)},
               {"99", summary.percentile_99, IM_COL32(255, 140, 100, 150)}};
  for (const auto& line : lines) {
    const float y = low.y + size.y * static_cast<float>(1 - std::min(1.0, line.ms / top_ms));
    list.AddLine({low.x, y}, {low.x + size.x, y}, line.color);
  }
  const std::string top = fmt::format("{:g} ms", top_ms);
  const ImVec2 text = ImGui::CalcTextSize(top.c_str());
  list.AddRectFilled(low, {low.x + text.x * 0.85f + 8, low.y + text.y * 0.85f + 4}, ground, 3);
  list.AddText(nullptr, font * 0.85f, {low.x + 4, low.y + 2}, palette::dim, top.c_str());
}

void explain_frame(const render::FrameRecord& record) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(
      fmt::format("frame {}   {} ms", record.frame, milliseconds(record.timings.total_ms)).c_str());
  for (std::size_t i = 0; i < render::frame_stages.size(); ++i) {
    const double ms = record.timings.*render::frame_stages[i].value;
    if (ms <= 0) continue;
    ImGui::PushStyleColor(ImGuiCol_Text, stage_colors[i]);
    ImGui::TextUnformatted(fmt::format("{:<12} {}", render::frame_stages[i].name, milliseconds(ms)).c_str());
    ImGui::PopStyleColor();
  }
  ImGui::EndTooltip();
}

/// One column per frame, its stages stacked from the bottom in the order they run; the rest of the frame is
/// grey.
void draw_graph(Ui& ui, const FrameHistory& history, const char* name) {
  const auto& records = history.records();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, ui.px(84)};
  ImGui::InvisibleButton(name, size);
  ui.mark(name);
  const ImVec2 low = ImGui::GetItemRectMin();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, ground, 3);
  if (records.empty()) return;
  const base::Summary summary = history.total_ms();
  const double top_ms = axis_end(summary.percentile_99 * 1.05);
  const float step = size.x / static_cast<float>(FrameHistory::capacity);
  const float first = size.x - step * static_cast<float>(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const float x = low.x + first + step * static_cast<float>(i);
    double below_ms = 0;
    const auto bar = [&](double ms, ImU32 color) {
      const double from = std::min(1.0, below_ms / top_ms), to = std::min(1.0, (below_ms + ms) / top_ms);
      below_ms += ms;
      if (to <= from) return;
      list.AddRectFilled({x, low.y + size.y * static_cast<float>(1 - to)},
                         {x + std::max(1.0f, step), low.y + size.y * static_cast<float>(1 - from)}, color);
    };
    for (std::size_t stage = 0; stage < render::frame_stages.size(); ++stage) {
      bar(records[i].timings.*render::frame_stages[stage].value, stage_colors[stage]);
    }
    bar(records[i].timings.total_ms - below_ms, IM_COL32(60, 62, 70, 255));
  }
  draw_marks_of(summary, low, size, top_ms, ImGui::GetFontSize());
  if (ImGui::IsItemHovered()) {
    const float at = (ImGui::GetIO().MousePos.x - low.x - first) / step;
    if (at >= 0) explain_frame(records[std::min(static_cast<std::size_t>(at), records.size() - 1)]);
  }
}

void draw_summary(const FrameHistory& history) {
  const base::Summary summary = history.total_ms();
  if (summary.count == 0) return;
  ImGui::TextUnformatted(fmt::format("median {}", milliseconds(summary.median)).c_str());
  ImGui::SameLine();
  dim_text(fmt::format("95 %: {}  99 %: {} ms  n = {}", milliseconds(summary.percentile_95),
                       milliseconds(summary.percentile_99), summary.count)
               .c_str());
}

void draw_stages(Ui& ui, const FrameHistory& history) {
  const auto& records = history.records();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < render::frame_stages.size(); ++i) {
    std::vector<double> values;
    values.reserve(records.size());
    for (const render::FrameRecord& record : records)
      values.push_back(record.timings.*render::frame_stages[i].value);
    const double median = base::summarize(values).median;
    if (median <= 0) continue;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x;
    const double share = median / std::max(1e-9, history.total_ms().median);
    list.AddRectFilled({at.x + ui.px(160), at.y + line * 0.3f},
                       {at.x + ui.px(160) + (width - ui.px(160)) * static_cast<float>(std::min(1.0, share)),
                        at.y + line * 0.8f},
                       stage_colors[i], 2);
    list.AddRectFilled({at.x, at.y + line * 0.3f}, {at.x + line * 0.5f, at.y + line * 0.8f}, stage_colors[i],
                       2);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line);
    dim_text(std::string(render::frame_stages[i].name).c_str());
    const std::string text = milliseconds(median);
    ImGui::SameLine(ui.px(164) - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextUnformatted(text.c_str());
  }
}

/// 1234567 as 1 234 567.
std::string grouped(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

void draw_counts(Ui& ui, const Picture& picture) {
  const bool two = picture.b.has_value();
  const float width = ImGui::GetContentRegionAvail().x;
  const float right_a = two ? width * 0.7f : width;
  const auto cell = [](const std::string& text, float right) {
    ImGui::SameLine(std::max(0.0f, right - ImGui::CalcTextSize(text.c_str()).x) +
                    ImGui::GetStyle().WindowPadding.x);
    ImGui::TextUnformatted(text.c_str());
  };
  const auto line = [&](const render::CountColumn& column) {
    const std::uint64_t a = column.value(picture.a.record), b = two ? column.value(picture.b->record) : 0;
    if (a == 0 && b == 0) return;
    dim_text(std::string(column.name).c_str());
    cell(grouped(a), right_a);
    if (two) cell(grouped(b), width);
  };
  if (two) {
    dim_text("counts");
    cell("A", right_a);
    cell("B", width);
  }
  for (const render::CountColumn& column : render::count_columns) line(column);
  for (const render::CountColumn& column : render::method_columns) line(column);
  for (const render::EstimateColumn& column : render::estimate_columns) {
    const double a = column.value(picture.a.record), b = two ? column.value(picture.b->record) : 0;
    if (a == 0 && b == 0) continue;
    dim_text(std::string(column.name).c_str());
    cell(fmt::format("{:.2f}", a), right_a);
    if (two) cell(fmt::format("{:.2f}", b), width);
  }
  (void)ui;
}

void draw_overlay_choice(Ui& ui) {
  constexpr const char* kinds[] = {"none", "nodes", "classes"};
  row(ui, "Overlay",
      "nodes: a heat map of the node tests for each pixel (hard shadows); classes: how soft shadows found "
      "each pixel's answer.");
  int kind = static_cast<int>(ui.state.overlay);
  if (segments(ui, "overlay", kinds, 3, kind)) ui.state.overlay = static_cast<Overlay>(kind);
  if (ui.state.overlay == Overlay::none) return;
  row(ui, "Opacity");
  ImGui::SliderFloat("##opacity", &ui.state.overlay_opacity, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  ui.mark("opacity");
  const render::ShadowMode shadows = ui.state.slots[ui.state.compare ? 0 : ui.state.active].render.shadows;
  if (ui.state.overlay == Overlay::nodes && shadows != render::ShadowMode::hard)
    dim_text("Only hard shadows have nodes to count.");
  if (ui.state.overlay == Overlay::classes && shadows != render::ShadowMode::soft)
    dim_text("Only soft shadows have classes.");
}

void choose_preview_time(Ui& ui) {
  row(ui, "Previews",
      "Time for a picture while you drag or hold a key. A picture that takes longer is shown as a preview "
      "first, and refined when you stop. 0: no previews.");
  float ms = static_cast<float>(ui.state.preview_ms);
  if (ImGui::SliderFloat("##preview time", &ms, 0, static_cast<float>(most_preview_ms),
                         ms > 0 ? "within %.0f ms" : "none", ImGuiSliderFlags_AlwaysClamp))
    ui.state.preview_ms = std::round(ms);
  ui.mark("preview time");
}

}  // namespace

void draw_cost_section(Ui& ui) {
  ImGui::Separator();
  ViewState& state = ui.state;
  const int first = state.compare ? 0 : state.active;
  const FrameHistory& history = ui.history[static_cast<std::size_t>(first)];
  draw_graph(ui, history, "graph");
  draw_summary(history);
  if (state.compare) {
    draw_graph(ui, ui.history[1], "graph b");
    draw_summary(ui.history[1]);
  }
  draw_overlay_choice(ui);
  choose_preview_time(ui);
  row(ui, "Log",
      "One row per frame, with the columns of tenebra render --log. The log ends where the settings change.");
  if (ImGui::Button(ui.log.empty() ? "Start (T)" : fmt::format("End {} (T)", ui.log).c_str(), {-1, 0})) {
    ui.actions.toggle_log = true;
  }
  ui.mark("log");
  draw_stages(ui, history);
  if (ui.picture) {
    ImGui::Separator();
    draw_counts(ui, *ui.picture);
  }
}

}  // namespace tenebra::viewer
