// Where sun is counted: faces, cells of a horizontal plane, points of a list; and the points that are asked
// about for each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/queries.h>

namespace tenebra::sun {

enum class ReceiverKind { faces, cells, points };

struct Receiver {
  std::uint32_t end = 0;                 ///< one past its last point; it begins where the one before ends
  std::uint32_t triangle = no_triangle;  ///< id in FrameGeometry
  int node = -1;                         ///< index into Scene::nodes
  double area_m2 = 0;                    ///< 0: of a point
  glm::dvec3 centre{0.0};                ///< metres, in the scene's coordinates
};

/// Cells in rows from north to south, each from west to east.
struct Grid {
  double west = 0, north = 0, height = 0;  ///< x, -z and y of the first cell's outer corner, metres
  double cell_m = 1;
  int columns = 0, rows = 0;
};

struct Receivers {
  ReceiverKind kind = ReceiverKind::faces;
  std::vector<Receiver> list;
  // What is asked: one for each point, or empty, as QueryPoints takes them.
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<std::int8_t> sides;
  std::vector<glm::vec3> normals;
  Grid grid;  ///< of cells

  QueryPoints points() const {
    return {.positions = positions, .triangles = triangles, .normals = normals, .sides = sides};
  }
  /// One past the last point of each of the list.
  std::vector<std::uint32_t> ends() const;
};

/// Which triangles, and how many points on each.
struct FaceChoice {
  std::vector<std::string> nodes, materials;  ///< by name, nodes with all below them; empty: all
  bool upward = false;      ///< only those whose front rises at most 60 degrees from the horizontal
  bool both_sides = false;  ///< the side that the sun is on; else the front
  int per_face = 16;        ///< points, rounded up to a square number
  double per_m2 = 0;        ///< points instead, of that density; 0: per_face
};
/// For each node whether it or one above it is called by one of these names. Fails on a name that the scene
/// does not have.
Expected<std::vector<bool>> nodes_called(const Scene& scene, std::span<const std::string> names);

/// Points in the middle of the equal parts that lines parallel to its edges cut a triangle into: strictly
/// inside, evenly spread, the same each time. Triangles without an area and hidden ones are left out. Fails
/// on names that the scene does not have, where nothing is left, and where points are too many.
Expected<Receivers> face_receivers(const Scene& scene, const FrameGeometry& frame, const FaceChoice& choice);

/// The middles of cells that cover the frame's triangles as seen from above, their edges at multiples of
/// `cell_m` in the file's coordinates. `height`: of the plane, along the file's up axis, in its unit.
Expected<Receivers> ground_receivers(const FrameGeometry& frame, const FileFrame& file, double height,
                                     double cell_m);

/// Columns x, y, z and, if there, nx, ny, nz (the half of space that a point sees; 0,0,0: all around) in the
/// file's coordinates; a row each, in their order.
Expected<Receivers> read_receivers(const std::filesystem::path& table, const FileFrame& file);

}  // namespace tenebra::sun
