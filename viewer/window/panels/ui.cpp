#include "window/panels/ui.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "math/srgb.h"

namespace tenebra::viewer {
namespace {

constexpr float font_px = 15.0f;
constexpr float label_px = 104.0f;

ImVec4 grey(float value, float alpha = 1) {
  return {value * 0.93f, value * 0.97f, value * 1.1f, alpha};
}

void load_font(float scale) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  for (const char* file :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"}) {
    std::error_code none;
    if (std::filesystem::is_regular_file(file, none) && fonts.AddFontFromFileTTF(file, font_px * scale))
      return;
  }
  ImFontConfig plain;  // built in, made for 13 pixels
  plain.SizePixels = 13.0f * std::max(1.0f, std::round(scale));
  fonts.AddFontDefault(&plain);
}

}  // namespace

const KeyPress* Ui::pressed(int code, bool repeat) const {
  for (const KeyPress& press : keys) {
    if (press.code == code && !press.ctrl && (repeat || !press.repeat)) return &press;
  }
  return nullptr;
}

void Ui::mark(const std::string& name) {
  if (!ImGui::IsItemVisible()) {
    marks.erase(name);
    return;
  }
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  marks[name] = {low.x, low.y, high.x, high.y};
}

void apply_style(float scale) {
  load_font(scale);
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.ScrollbarSize = 10;
  style.GrabMinSize = 10;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
  style.ScrollbarRounding = 6;
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.ScaleAllSizes(scale);
  ImVec4* colors = style.Colors;
  const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(palette::accent);
  const auto faded = [&](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
  colors[ImGuiCol_Text] = ImGui::ColorConvertU32ToFloat4(palette::text);
  colors[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(palette::dim);
  colors[ImGuiCol_WindowBg] = ImGui::ColorConvertU32ToFloat4(palette::panel);
  colors[ImGuiCol_ChildBg] = {0, 0, 0, 0};
  colors[ImGuiCol_PopupBg] = grey(0.12f, 0.98f);
  colors[ImGuiCol_Border] = colors[ImGuiCol_Separator] = ImGui::ColorConvertU32ToFloat4(palette::line);
  colors[ImGuiCol_FrameBg] = colors[ImGuiCol_Button] = grey(0.17f);
  colors[ImGuiCol_FrameBgHovered] = colors[ImGuiCol_ButtonHovered] = grey(0.23f);
  colors[ImGuiCol_FrameBgActive] = colors[ImGuiCol_ButtonActive] = grey(0.28f);
  colors[ImGuiCol_Header] = grey(0.13f);
  colors[ImGuiCol_HeaderHovered] = grey(0.18f);
  colors[ImGuiCol_HeaderActive] = grey(0.22f);
  colors[ImGuiCol_CheckMark] = colors[ImGuiCol_SliderGrab] = faded(0.9f);
  colors[ImGuiCol_SliderGrabActive] = accent;
  colors[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
  colors[ImGuiCol_ScrollbarGrab] = grey(0.24f);
  colors[ImGuiCol_TextSelectedBg] = faded(0.35f);
  colors[ImGuiCol_PlotHistogram] = accent;
}

void tooltip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool edit_color(Ui& ui, const std::string& mark, glm::vec3& color) {
  const bool encoded = ui.state.scene->scene.transfer == Transfer::srgb;
  glm::vec3 shown = color;
  for (int k = 0; k < 3 && encoded; ++k) shown[k] = math::srgb_of_linear(color[k]);
  const bool changed = ImGui::ColorEdit3(("##" + mark).c_str(), &shown.x, ImGuiColorEditFlags_Float);
  ui.mark(mark);
  if (!changed) return false;
  for (int k = 0; k < 3; ++k)
    color[k] = encoded ? math::linear_of_srgb(std::max(0.0f, shown[k])) : std::max(0.0f, shown[k]);
  return true;
}

bool edit_coordinates(const char* name, glm::dvec3& place) {
  return ImGui::DragScalarN(name, ImGuiDataType_Double, &place.x, 3, 0.05f, nullptr, nullptr, "%.3f");
}

void dim_text(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

void row(const Ui& ui, const char* label, const char* help) {
  ImGui::AlignTextToFramePadding();
  dim_text(label);
  if (help) tooltip(help);
  ImGui::SameLine(ui.px(label_px) + ImGui::GetStyle().WindowPadding.x);
  ImGui::SetNextItemWidth(-1);
}

bool section(Ui& ui, const char* title, bool open) {
  const bool is_open =
      ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  ui.mark(std::string("section.") + title);
  return is_open;
}

namespace {

/// Widths of buttons side by side, `whole` in all: the same, unless a label needs more.
std::vector<float> widths_of(const char* const* labels, int count, float whole) {
  std::vector<float> needed;
  float sum = 0, most = 0;
  for (int i = 0; i < count; ++i) {
    needed.push_back(ImGui::CalcTextSize(labels[i]).x + 2 * ImGui::GetStyle().FramePadding.x);
    sum += needed.back();
    most = std::max(most, needed.back());
  }
  const float each = whole / static_cast<float>(count);
  const bool fits = most <= each;
  for (float& width : needed) width = fits ? each : width + (whole - sum) / static_cast<float>(count);
  return needed;
}

}  // namespace

bool segments(Ui& ui, const std::string& name, const char* const* labels, int count, int& chosen) {
  const float gap = ui.px(2);
  const std::vector<float> widths =
      widths_of(labels, count, ImGui::GetContentRegionAvail().x - gap * static_cast<float>(count - 1));
  bool changed = false;
  ImGui::PushID(name.c_str());
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine(0, gap);
    const bool down = i == chosen;
    if (down)
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::ColorConvertU32ToFloat4(IM_COL32(50, 92, 168, 255)));
    if (ImGui::Button(labels[i], {widths[static_cast<std::size_t>(i)], 0}) && !down) {
      chosen = i;
      changed = true;
    }
    if (down) ImGui::PopStyleColor();
    ui.mark(name + "." + labels[i]);
  }
  ImGui::PopID();
  return changed;
}

}  // namespace tenebra::viewer
