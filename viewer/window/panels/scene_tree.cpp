// The tree of the scene's nodes: which are visible, and which cast shadows.
#include "window/panels/scene_tree.h"

#include <fmt/core.h>

#include <algorithm>

#include "window/panels/panels.h"

namespace tenebra::viewer {
namespace {

std::string name_of(const Scene& scene, int node) {
  const Node& found = scene.nodes[static_cast<std::size_t>(node)];
  if (!found.name.empty()) return found.name;
  if (found.mesh >= 0) {
    const std::string& mesh = scene.meshes[static_cast<std::size_t>(found.mesh)].name;
    if (!mesh.empty()) return mesh;
  }
  const char* kind = found.mesh >= 0     ? "mesh"
                     : found.light >= 0  ? "light"
                     : found.camera >= 0 ? "camera"
                                         : "node";
  return fmt::format("{} {}", kind, node);
}

void list_children(const Scene& scene, SceneTree& tree) {
  tree.children.assign(scene.nodes.size() + 1, {});
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    tree.children[static_cast<std::size_t>(scene.nodes[i].parent + 1)].push_back(static_cast<int>(i));
  tree.open.assign(scene.nodes.size(), tree.children[0].size() == 1 ? 1 : 0);
}

void add_rows(const Scene& scene, const SceneTree& tree, int parent, int depth, std::vector<TreeRow>& rows) {
  for (const int node : tree.children[static_cast<std::size_t>(parent + 1)]) {
    rows.push_back({node, depth});
    if (tree.open[static_cast<std::size_t>(node)] != 0) add_rows(scene, tree, node, depth + 1, rows);
  }
}

std::vector<TreeRow> rows_of(const Scene& scene, const SceneTree& tree) {
  std::vector<TreeRow> rows;
  const std::string filter = tree.filter.data();
  if (filter.empty()) {
    add_rows(scene, tree, -1, 0, rows);
    return rows;
  }
  for (int i = 0; i < static_cast<int>(scene.nodes.size()); ++i) {
    if (matches(name_of(scene, i), filter)) rows.push_back({i, 0});
  }
  return rows;
}

void open_above(const Scene& scene, int node, SceneTree& tree) {
  for (int at = scene.nodes[static_cast<std::size_t>(node)].parent; at >= 0;
       at = scene.nodes[static_cast<std::size_t>(at)].parent)
    tree.open[static_cast<std::size_t>(at)] = 1;
}

/// Whether the node or one above it has this switched off.
bool off_above(const ViewState& state, int node, bool stage::NodeEdit::*flag) {
  const auto& nodes = state.scene->scene.nodes;
  for (int at = nodes[static_cast<std::size_t>(node)].parent; at >= 0;
       at = nodes[static_cast<std::size_t>(at)].parent) {
    const auto edit = state.edits.nodes.find(at);
    if (edit != state.edits.nodes.end() && !(edit->second.*flag)) return true;
  }
  return false;
}

void flag_box(Ui& ui, int node, bool stage::NodeEdit::*flag, const char* name, const char* help) {
  auto& edits = ui.state.edits.nodes;
  const auto found = edits.find(node);
  bool on = found == edits.end() || found->second.*flag;
  const bool off = off_above(ui.state, node, flag);
  if (off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
  if (ImGui::Checkbox(fmt::format("##{}", name).c_str(), &on)) {
    edits[node].*flag = on;
    if (edits[node] == stage::NodeEdit{}) edits.erase(node);
  }
  if (off) ImGui::PopStyleVar();
  ui.mark(fmt::format("node.{}.{}", node, name));
  tooltip(off ? "Switched off above." : help);
}

void draw_row(Ui& ui, SceneTree& tree, const TreeRow& row) {
  const Scene& scene = ui.state.scene->scene;
  const bool is_parent = !tree.children[static_cast<std::size_t>(row.node + 1)].empty();
  char& open = tree.open[static_cast<std::size_t>(row.node)];
  ImGui::PushID(row.node);
  flag_box(ui, row.node, &stage::NodeEdit::visible, "visible", "Visible, with all below it.");
  ImGui::SameLine(0, ui.px(3));
  flag_box(ui, row.node, &stage::NodeEdit::casts, "casts", "Casts shadows, with all below it.");
  ImGui::SameLine(0, ui.px(6) + ui.px(12) * static_cast<float>(row.depth));
  if (is_parent && tree.filter[0] == 0) {
    if (ImGui::ArrowButton("##open", open != 0 ? ImGuiDir_Down : ImGuiDir_Right)) open = open == 0;
    ImGui::SameLine(0, ui.px(4));
  }
  const bool selected = ui.state.selected_node == row.node;
  if (ImGui::Selectable(name_of(scene, row.node).c_str(), selected)) ui.state.selected_node = row.node;
  ui.mark(fmt::format("node.{}", row.node));
  ImGui::PopID();
}

/// What the selected node holds.
void draw_selected(Ui& ui) {
  const int number = ui.state.selected_node;
  if (number < 0) return;
  const Scene& scene = ui.state.scene->scene;
  const Node& node = scene.nodes[static_cast<std::size_t>(number)];
  if (node.mesh < 0) return;
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
  std::vector<std::uint32_t> used = mesh.materials;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  dim_text(fmt::format("{}: {} triangle{}, {} material{}", name_of(scene, number), mesh.triangles.size(),
                       mesh.triangles.size() == 1 ? "" : "s", used.size(), used.size() == 1 ? "" : "s")
               .c_str());
  if (used.size() == 1 && ImGui::SmallButton("edit its material")) {
    ui.state.selected_material = static_cast<int>(used.front());
  }
  if (used.size() == 1) ui.mark("node material");
}

}  // namespace

void draw_tree_section(Ui& ui) {
  if (!ui.state.scene) return;
  SceneTree& tree = ui.state.tree;
  if (tree.shown_node != ui.state.selected_node && ui.state.selected_node >= 0) ImGui::SetNextItemOpen(true);
  if (!section(ui, "Scene", false)) return;
  const Scene& scene = ui.state.scene->scene;
  if (tree.scene != ui.state.scene) {
    tree = {};
    tree.scene = ui.state.scene;
    list_children(scene, tree);
  }
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##filter", "find a node by its name", tree.filter.data(), tree.filter.size());
  ui.mark("node filter");
  dim_text("visible, casts shadows");
  const bool moves_to = std::exchange(tree.shown_node, ui.state.selected_node) != ui.state.selected_node &&
                        ui.state.selected_node >= 0;
  if (moves_to) open_above(scene, ui.state.selected_node, tree);
  const std::vector<TreeRow> rows = rows_of(scene, tree);
  const float line = ImGui::GetFrameHeightWithSpacing();
  const float height = line * std::clamp(static_cast<float>(rows.size()), 2.0f, 11.0f);
  ImGui::BeginChild("tree", {0, height});
  if (moves_to) {
    const auto at = std::find_if(rows.begin(), rows.end(),
                                 [&](const TreeRow& row) { return row.node == ui.state.selected_node; });
    ImGui::SetScrollY(std::max(0.0f, line * static_cast<float>(at - rows.begin()) - height / 2));
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()), line);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_row(ui, tree, rows[static_cast<std::size_t>(i)]);
  }
  ImGui::EndChild();
  draw_selected(ui);
}

}  // namespace tenebra::viewer
