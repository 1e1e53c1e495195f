#include "sun/receivers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/fail.h"
#include "scene/frame_parts.h"
#include "sun/columns.h"

namespace tenebra::sun {
namespace {

using glm::dvec3;

constexpr std::size_t most_points = std::size_t{1} << 25;
constexpr int most_parts = 256;  // along an edge of a face: 65,536 points on it

Expected<void> check_points(double points) {
  if (points <= static_cast<double>(most_points)) return {};
  return base::fail(
      "found {:.0f} points to ask about, expected at most {}; fewer for each face, larger cells or a part of "
      "the scene",
      points, most_points);
}

bool is_named(std::span<const std::string> names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Expected<std::vector<bool>> chosen_materials(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<bool> chosen;
  for (const Material& material : scene.materials)
    chosen.push_back(names.empty() || is_named(names, material.name));
  for (const std::string& name : names)
    if (std::none_of(scene.materials.begin(), scene.materials.end(),
                     [&](const Material& material) { return material.name == name; }))
      return base::fail("found no material called {}, expected one of the scene's; tenebra info lists them",
                        name);
  return chosen;
}

/// Parts along an edge: the square root of the number of points.
int parts_of(const FaceChoice& choice, double area_m2) {
  const double points = choice.per_m2 > 0 ? choice.per_m2 * area_m2 : choice.per_face;
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(std::min(points, 1e9)))), 1, most_parts);
}

/// The middles of the n * n equal triangles that a triangle is cut into.
void add_points(const std::array<dvec3, 3>& corners, int n, std::vector<dvec3>& out) {
  const dvec3 a = (corners[1] - corners[0]) / static_cast<double>(n),
              b = (corners[2] - corners[0]) / static_cast<double>(n);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n - row; ++column) {
      const double i = column, j = row;
      out.push_back(corners[0] + (i + 1.0 / 3) * a + (j + 1.0 / 3) * b);
      if (column + row + 1 < n) out.push_back(corners[0] + (i + 2.0 / 3) * a + (j + 2.0 / 3) * b);
    }
}

/// What is known of a triangle before points are made.
struct Face {
  std::array<dvec3, 3> corners;
  double area_m2;
  dvec3 normal;  ///< unit
};
std::optional<Face> face_of(const FrameGeometry& frame, std::size_t triangle) {
  Face face{};
  for (int k = 0; k < 3; ++k)
    face.corners[static_cast<std::size_t>(k)] = dvec3(frame.positions[frame.triangles[triangle][k]]);
  const dvec3 cross = glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
  const double length = glm::length(cross);
  if (!(length > 0)) return std::nullopt;
  face.area_m2 = length / 2, face.normal = cross / length;
  return face;
}

void add_face(const Face& face, std::size_t triangle, int node, int parts, const FaceChoice& choice,
              Receivers& out) {
  add_points(face.corners, parts, out.positions);
  out.triangles.resize(out.positions.size(), static_cast<std::uint32_t>(triangle));
  if (!choice.both_sides) out.sides.resize(out.positions.size(), 1);
  out.list.push_back({static_cast<std::uint32_t>(out.positions.size()), static_cast<std::uint32_t>(triangle),
                      node, face.area_m2, (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0});
}

}  // namespace

Expected<std::vector<bool>> nodes_called(const Scene& scene, std::span<const std::string> names) {
  for (const std::string& name : names)
    if (std::none_of(scene.nodes.begin(), scene.nodes.end(),
                     [&](const Node& node) { return node.name == name; }))
      return base::fail("found no node called {}, expected one of the scene's; tenebra info lists them",
                        name);
  std::vector<bool> called;
  for (const Node& node : scene.nodes)
    called.push_back(is_named(names, node.name) ||
                     (node.parent >= 0 && called[static_cast<std::size_t>(node.parent)]));
  return called;
}

std::vector<std::uint32_t> Receivers::ends() const {
  std::vector<std::uint32_t> ends;
  for (const Receiver& receiver : list) ends.push_back(receiver.end);
  return ends;
}

Expected<Receivers> face_receivers(const Scene& scene, const FrameGeometry& frame, const FaceChoice& choice) {
  const auto nodes = choice.nodes.empty()
                         ? Expected<std::vector<bool>>(std::vector<bool>(scene.nodes.size(), true))
                         : nodes_called(scene, choice.nodes);
  if (!nodes) return tl::unexpected(nodes.error());
  const auto materials = chosen_materials(scene, choice.materials);
  if (!materials) return tl::unexpected(materials.error());
  Receivers out;
  std::size_t part = 0;
  for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
    if (scene.nodes[node].mesh < 0) continue;
    const auto [first, end] = scene::triangles_of_part(frame, part++);
    for (std::size_t t = first; t < end; ++t) {
      if (!(*nodes)[node] || !(*materials)[frame.materials[t]]) continue;
      const auto face = face_of(frame, t);
      if (!face || (choice.upward && face->normal.y < 0.5)) continue;
      const int parts = parts_of(choice, face->area_m2);
      const double points = static_cast<double>(out.positions.size()) + static_cast<double>(parts) * parts;
      if (auto checked = check_points(points); !checked) return tl::unexpected(checked.error());
      add_face(*face, t, static_cast<int>(node), parts, choice, out);
    }
  }
  if (out.list.empty())
    return base::fail(
        "found no face to count the sun on, expected one with an area that is visible and chosen");
  return out;
}

Expected<Receivers> ground_receivers(const FrameGeometry& frame, const FileFrame& file, double height,
                                     double cell_m) {
  glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);  // east and north
  for (const glm::uvec3& triangle : frame.triangles)
    for (int k = 0; k < 3; ++k) {
      if (triangle == glm::uvec3(0)) continue;
      const glm::vec3 at = frame.positions[triangle[k]];
      low = glm::min(low, glm::dvec2(at.x, -at.z)), high = glm::max(high, glm::dvec2(at.x, -at.z));
    }
  if (!(low.x <= high.x))
    return base::fail("found no triangle in the scene, expected one to lay the ground's cells under");
  const dvec3 shift =
      file.direction_to_scene(file.origin * file.metres_per_unit);  // the scene's origin in the file
  const glm::dvec2 origin(shift.x, -shift.z);
  const glm::dvec2 first = glm::floor((low + origin) / cell_m),
                   end = glm::max(glm::ceil((high + origin) / cell_m), first + 1.0);
  const glm::dvec2 cells = end - first;
  if (auto checked = check_points(cells.x * cells.y); !checked) return tl::unexpected(checked.error());
  Receivers out;
  out.kind = ReceiverKind::cells;
  out.grid = {
      first.x * cell_m - origin.x, end.y * cell_m - origin.y, height * file.metres_per_unit - shift.y, cell_m,
      static_cast<int>(cells.x),   static_cast<int>(cells.y)};
  for (int row = 0; row < out.grid.rows; ++row)
    for (int column = 0; column < out.grid.columns; ++column) {
      const dvec3 at(out.grid.west + (column + 0.5) * cell_m, out.grid.height,
                     -(out.grid.north - (row + 0.5) * cell_m));
      out.positions.push_back(at);
      out.list.push_back(
          {static_cast<std::uint32_t>(out.positions.size()), no_triangle, -1, cell_m * cell_m, at});
    }
  out.normals.assign(out.positions.size(), glm::vec3(0, 1, 0));
  return out;
}

Expected<Receivers> read_receivers(const std::filesystem::path& table, const FileFrame& file) {
  constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};
  const auto columns = read_columns(table, names);
  if (!columns) return tl::unexpected(columns.error());
  for (std::size_t i = 0; i < 3; ++i)
    if (!columns->has(i))
      return base::fail("{}: found no column {}, expected x, y and z", table.string(), names[i]);
  const bool normals = columns->has(3) && columns->has(4) && columns->has(5);
  if (!normals && (columns->has(3) || columns->has(4) || columns->has(5)))
    return base::fail("{}: found a part of the columns nx, ny, nz, expected all three or none",
                      table.string());
  if (auto checked = check_points(static_cast<double>(columns->rows)); !checked)
    return tl::unexpected(checked.error());
  const auto& v = columns->values;
  Receivers out;
  out.kind = ReceiverKind::points;
  for (std::size_t i = 0; i < columns->rows; ++i) {
    const dvec3 at = file.to_scene({v[0][i], v[1][i], v[2][i]});
    out.positions.push_back(at);
    if (normals) out.normals.emplace_back(file.direction_to_scene({v[3][i], v[4][i], v[5][i]}));
    out.list.push_back({static_cast<std::uint32_t>(i + 1), no_triangle, -1, 0, at});
  }
  return out;
}

}  // namespace tenebra::sun
