#include "sun/hours_model.h"

#include <fmt/format.h>

#include <array>

#include "base/fail.h"
#include "math/srgb.h"
#include "scene/frame_parts.h"

namespace tenebra::sun {
namespace {

constexpr double not_asked = -1;

/// A mesh in one colour after the other, and its numbers.
class Painter {
public:
  Painter(HoursModel& model, const ColourScale& scale) : model_(model), scale_(scale) {}

  void begin(const std::string& name) {
    model_.scene.nodes.push_back({.name = name, .mesh = static_cast<int>(model_.scene.meshes.size())});
    model_.scene.meshes.push_back({.name = name});
    model_.additions.numbers.emplace_back();
  }
  /// Triangles of three or four corners; a fan.
  void add(std::span<const glm::vec3> corners, double value) {
    Mesh& mesh = model_.scene.meshes.back();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec4 colour = colour_of(value);
    for (const glm::vec3& corner : corners) {
      mesh.positions.push_back(corner), mesh.colors.push_back(colour);
      model_.additions.numbers.back().push_back(static_cast<float>(value));
    }
    for (std::uint32_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.emplace_back(first, first + k - 1, first + k);
      mesh.materials.push_back(0);
    }
  }

private:
  glm::vec4 colour_of(double value) const {
    if (value == not_asked) return {0.4f, 0.4f, 0.4f, 1};
    const glm::vec3 shown = scale_(value);
    return {math::linear_of_srgb(shown.r), math::linear_of_srgb(shown.g), math::linear_of_srgb(shown.b), 1};
  }

  HoursModel& model_;
  const ColourScale& scale_;
};

std::vector<double> values_of_triangles(const Study& study) {
  std::vector<double> values(study.frame.triangles.size(), not_asked);
  for (std::size_t i = 0; i < study.receivers.list.size(); ++i)
    if (const std::uint32_t triangle = study.receivers.list[i].triangle; triangle != no_triangle)
      values[triangle] = value_of(study, i);
  return values;
}

void paint_nodes(const Study& study, Painter& painter) {
  const FrameGeometry& frame = study.frame;
  const std::vector<double> values = values_of_triangles(study);
  std::size_t part = 0;
  for (const Node& node : study.scene.nodes) {
    if (node.mesh < 0) continue;
    const auto [first, end] = scene::triangles_of_part(frame, part++);
    painter.begin(node.name);
    for (std::size_t t = first; t < end; ++t) {
      const glm::uvec3 corners = frame.triangles[t];
      if (corners == glm::uvec3(0)) continue;  // hidden or dropped
      const std::array at{frame.positions[corners.x], frame.positions[corners.y], frame.positions[corners.z]};
      painter.add(at, values[t]);
    }
  }
}

void paint_ground(const Study& study, Painter& painter) {
  const Grid& grid = study.receivers.grid;
  painter.begin("ground");
  for (std::size_t i = 0; i < study.receivers.list.size(); ++i) {
    const auto row = static_cast<double>(i / static_cast<std::size_t>(grid.columns)),
               column = static_cast<double>(i % static_cast<std::size_t>(grid.columns));
    // By the lines of the grid, so that neighbours have the same corners.
    const double west = grid.west + column * grid.cell_m, east = grid.west + (column + 1) * grid.cell_m,
                 north = row * grid.cell_m - grid.north, south = (row + 1) * grid.cell_m - grid.north;
    const std::array<glm::vec3, 4> at{
        glm::vec3(west, grid.height, south), glm::vec3(east, grid.height, south),
        glm::vec3(east, grid.height, north), glm::vec3(west, grid.height, north)};
    painter.add(at, value_of(study, i));
  }
}

}  // namespace

Expected<HoursModel> model_of(const Study& study, const ColourScale& scale) {
  if (study.receivers.kind == ReceiverKind::points)
    return base::fail("found points of a list, expected faces or a ground to colour; a table has points");
  HoursModel model;
  model.scene.name = study.scene.name, model.scene.frame = study.scene.frame;
  const Quantity quantity = quantity_of(study.suns);
  Material material;
  material.name = quantity.name, material.base_color = glm::vec3(1), material.model = SurfaceModel::unlit;
  model.scene.materials.push_back(material);
  model.additions.attribute = quantity.attribute;
  model.additions.notes = {{"colours", fmt::format("viridis, 0 to {:.6g} {}", scale.most, quantity.name)}};
  if (study.suns.timed()) model.additions.notes.emplace_back("zone", zone_text(study.suns.zone_min));
  Painter painter(model, scale);
  paint_nodes(study, painter);
  if (study.receivers.kind == ReceiverKind::cells) paint_ground(study, painter);
  return model;
}

}  // namespace tenebra::sun
