// Objects for the tests of fields: shapes with known visibility, and meshes of files.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/frame_geometry.h>
#include "ao/field/displacement_field.h"
#include "formats/import_scene.h"

namespace tenebra::testing {

inline constexpr FieldLayout paper = FieldLayout::positions_directions, chords = FieldLayout::chords;

struct Object {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;

  trees::TriangleBvh bvh() const { return trees::build_triangle_bvh(positions, triangles); }
  ao::DisplacementField field(const ao::FieldSettings& settings = {}) const {
    return *ao::build_field(positions, triangles, bvh(), settings);
  }
};

inline void add_quad(Object& object, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const auto first = static_cast<std::uint32_t>(object.positions.size());
  object.positions.insert(object.positions.end(), {a, b, c, d});
  object.triangles.emplace_back(first, first + 1, first + 2);
  object.triangles.emplace_back(first, first + 2, first + 3);
}

inline void add_box(Object& object, glm::vec3 low, glm::vec3 high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      glm::vec3 corner[4];
      for (int k = 0; k < 4; ++k) {
        corner[k] = low;
        corner[k][axis] = upper ? high[axis] : low[axis];
        if (k == 1 || k == 2) corner[k][(axis + 1) % 3] = high[(axis + 1) % 3];
        if (k >= 2) corner[k][(axis + 2) % 3] = high[(axis + 2) % 3];
      }
      if (upper) {
        add_quad(object, corner[0], corner[1], corner[2], corner[3]);
      } else {
        add_quad(object, corner[0], corner[3], corner[2], corner[1]);
      }
    }
  }
}

/// A table: a plate on four legs, with much air inside its bounding sphere.
inline Object table() {
  Object object;
  add_box(object, {-1, 0.7f, -0.6f}, {1, 0.8f, 0.6f});
  for (const float x : {-0.9f, 0.8f})
    for (const float z : {-0.5f, 0.4f}) add_box(object, {x, 0, z}, {x + 0.1f, 0.7f, z + 0.1f});
  return object;
}

/// A sphere of `rings` x 2 `rings` quads, for others a ball squeezed along the axes.
inline Object ball(glm::vec3 centre, glm::vec3 radii, int rings) {
  Object object;
  const auto at = [&](int ring, int sector) {
    const double theta = ring * M_PI / rings, phi = (sector % (2 * rings)) * M_PI / rings;
    return centre + radii * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < 2 * rings; ++sector)
      add_quad(object, at(ring, sector), at(ring, sector + 1), at(ring + 1, sector + 1),
               at(ring + 1, sector));
  return object;
}

/// All triangles of a file at rest; nothing if there is no such file.
inline std::optional<Object> object_of(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const Expected<Scene> scene = formats::import_scene(path);
  if (!scene) return std::nullopt;
  FrameGeometry geometry;
  evaluate_frame(*scene, -1, 0, geometry);
  return Object{geometry.positions, geometry.triangles};
}

/// The mesh of most triangles in a file.
inline std::optional<Object> largest_mesh_of(const std::filesystem::path& path) {
  const Expected<Scene> scene = formats::import_scene(path);
  if (!scene || scene->meshes.empty()) return std::nullopt;
  const Mesh* largest = &scene->meshes.front();
  for (const Mesh& mesh : scene->meshes)
    if (mesh.triangles.size() > largest->triangles.size()) largest = &mesh;
  return Object{largest->positions, largest->triangles};
}

}  // namespace tenebra::testing
