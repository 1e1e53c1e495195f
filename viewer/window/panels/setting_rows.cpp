#include "window/panels/setting_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "settings/tables.h"

namespace tenebra::viewer {
namespace {

/// The setting, which the table must have.
const settings::Setting<MethodOptions>& method_setting(std::string_view name) {
  return *settings::find(settings::method_table(), name);
}

}  // namespace

void setting_row(const Ui& ui, const char* label, std::string_view name) {
  row(ui, label, std::string(method_setting(name).help).c_str());
}

void edit_words(Ui& ui, MethodOptions& method, const char* label, std::string_view name,
                const std::string& mark) {
  const auto& setting = method_setting(name);
  setting_row(ui, label, name);
  const std::vector<std::string> words(setting.words.begin(), setting.words.end());
  std::vector<const char*> labels;
  for (const std::string& word : words) labels.push_back(word.c_str());
  int chosen = static_cast<int>(std::find(words.begin(), words.end(), setting.text(method)) - words.begin());
  if (segments(ui, mark, labels.data(), static_cast<int>(labels.size()), chosen))
    static_cast<void>(setting.read(method, words[static_cast<std::size_t>(chosen)]));  // one of its words
}

void edit_number(Ui& ui, MethodOptions& method, const char* label, std::string_view name, const char* mark,
                 int step) {
  const auto& setting = method_setting(name);
  setting_row(ui, label, name);
  int value = settings::number_from<int>(setting.text(method)).value_or(0);
  if (number_field(ui, mark, value, static_cast<int>(setting.range.low), static_cast<int>(setting.range.high),
                   step))
    static_cast<void>(setting.read(method, fmt::format("{}", value)));  // within its range
}

bool number_field(Ui& ui, const char* mark, int& value, int low, int high, int step) {
  ImGui::PushID(mark);
  const bool changed =
      ImGui::InputInt("##value", &value, step, step * 8, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::PopID();
  ui.mark(mark);
  if (changed) value = std::clamp(value, low, high);
  return changed;
}

}  // namespace tenebra::viewer
