#include "window/panels/open_dialog.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

/// What a row stands for.
struct Row {
  std::string name;  // as shown
  fs::path path;
  bool folder = false;
  bool recent = false;
};

void enter_folder(OpenDialog& dialog, const fs::path& folder) {
  auto list = list_folder(folder);
  dialog.problem = list ? "" : list.error().message;
  if (!list) return;
  dialog.list = std::move(*list);
  dialog.typed.fill(0);
  ++dialog.turn;
  dialog.chosen = 0;
}

/// Recent files, then what the folder has: of both, what matches the typed text.
std::vector<Row> rows_of(const Ui& ui, const OpenDialog& dialog) {
  const std::string typed = dialog.typed.data();
  std::vector<Row> rows;
  std::error_code none;
  for (const std::string& file : ui.state.settings.recent) {
    const fs::path path(file);
    if (matches(file, typed) && fs::is_regular_file(path, none))
      rows.push_back(
          {fmt::format("{}   {}", path.filename().string(), path.parent_path().string()), path, false, true});
  }
  if (typed.empty() && dialog.list.folder.has_relative_path())
    rows.push_back({"..", dialog.list.folder.parent_path(), true, false});
  for (const FolderEntry& entry : dialog.list.entries) {
    if (matches(entry.name, typed))
      rows.push_back(
          {entry.name + (entry.folder ? "/" : ""), dialog.list.folder / entry.name, entry.folder, false});
  }
  return rows;
}

/// True if the dialog is done.
bool take(Ui& ui, OpenDialog& dialog, const fs::path& path) {
  std::error_code none;
  if (fs::is_directory(path, none)) {
    enter_folder(dialog, path);
    return false;
  }
  if (!fs::exists(path, none)) {
    dialog.problem = fmt::format("{}: there is no such file.", path.string());
    return false;
  }
  ui.actions.open = path.string();
  return true;
}

/// Arrows, Enter, Backspace and Escape. True if the dialog is done.
bool use_keys(Ui& ui, OpenDialog& dialog, const std::vector<Row>& rows, bool was_empty) {
  const std::string typed = dialog.typed.data();
  const int last = std::max(0, static_cast<int>(rows.size()) - 1);
  if (ui.pressed(key_code::down, true)) dialog.chosen = std::min(dialog.chosen + 1, last);
  if (ui.pressed(key_code::up, true)) dialog.chosen = std::max(dialog.chosen - 1, 0);
  if (ui.pressed(key_code::escape)) return true;
  if (ui.pressed(key_code::backspace) && was_empty && dialog.list.folder.has_relative_path())
    enter_folder(dialog, dialog.list.folder.parent_path());
  if (!ui.pressed(key_code::enter) && !ui.pressed(key_code::keypad_enter)) return false;
  if (typed.find('/') != std::string::npos || typed.starts_with('~'))
    return take(ui, dialog, typed_path(typed, dialog.list.folder));
  return !rows.empty() && take(ui, dialog, rows[static_cast<std::size_t>(dialog.chosen)].path);
}

/// True if the dialog is done.
bool draw_rows(Ui& ui, OpenDialog& dialog, const std::vector<Row>& rows, bool key_moved) {
  bool was_recent = false, done = false;
  std::optional<fs::path> taken;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    if (row.recent && i == 0) dim_text("Recent");
    if (!row.recent && (was_recent || i == 0)) dim_text(dialog.list.folder.c_str());
    was_recent = row.recent;
    ImGui::PushID(i);
    if (ImGui::Selectable(row.name.c_str(), i == dialog.chosen, ImGuiSelectableFlags_DontClosePopups))
      taken = row.path;
    ui.mark(fmt::format("open.row.{}", row.recent ? "recent " + row.path.filename().string() : row.name));
    if (i == dialog.chosen && key_moved) ImGui::SetScrollHereY();
    ImGui::PopID();
  }
  if (rows.empty()) dim_text("No scene has this name here.");
  if (dialog.list.cut) dim_text(fmt::format("The first {} are shown.", FolderList::most_entries).c_str());
  if (taken) done = take(ui, dialog, *taken);
  return done;
}

}  // namespace

OpenDialog open_dialog_at(const std::string& folder) {
  OpenDialog dialog;
  auto list = list_folder(folder.empty() ? "." : folder);
  if (!list) list = list_folder(".");
  if (!list) list = list_folder("/");
  if (list) dialog.list = std::move(*list);
  return dialog;
}

void draw_open_dialog(Ui& ui, ImVec2 window) {
  if (!ui.state.open_dialog) return;
  OpenDialog& dialog = *ui.state.open_dialog;
  const ImVec2 size{std::min(window.x - ui.px(20), ui.px(640)), std::min(window.y - ui.px(20), ui.px(520))};
  ImGui::SetNextWindowPos({(window.x - size.x) / 2, (window.y - size.y) / 2});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  if (dialog.fresh) ImGui::SetNextWindowFocus();
  ImGui::Begin("##open", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  ImGui::TextUnformatted("Open a scene");
  ImGui::SameLine(size.x - ImGui::CalcTextSize("close (Esc)").x - ui.px(14));
  dim_text("close (Esc)");
  bool done = ImGui::IsItemClicked();
  ui.mark("open.close");
  const bool was_empty = dialog.typed[0] == 0;
  ImGui::SetNextItemWidth(-1);
  if (dialog.fresh || !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  dialog.fresh = false;
  if (ImGui::InputTextWithHint(fmt::format("##typed{}", dialog.turn).c_str(),
                               "type a part of a name, or a path", dialog.typed.data(), dialog.typed.size()))
    dialog.chosen = 0;
  ui.mark("open.typed");
  const std::vector<Row> rows = rows_of(ui, dialog);
  dialog.chosen = std::clamp(dialog.chosen, 0, std::max(0, static_cast<int>(rows.size()) - 1));
  ImGui::BeginChild("rows", {0, -ImGui::GetFrameHeightWithSpacing()});
  done = draw_rows(ui, dialog, rows, !ui.keys.empty()) || done;
  ImGui::EndChild();
  dim_text(dialog.problem.empty() ? "Up, Down, Enter; Backspace: the folder above. glTF, GLB, AFF, NFF, OBJ"
                                  : dialog.problem.c_str());
  done = use_keys(ui, dialog, rows, was_empty) || done;
  ImGui::End();
  ImGui::PopStyleVar();
  if (done) ui.state.open_dialog.reset();
}

}  // namespace tenebra::viewer
