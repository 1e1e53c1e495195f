// The objects that the measurements of ambient occlusion look at: out of scene files, or generated.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>

namespace tenebra::bench {

/// Triangles in the object's own space.
struct Object {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// The object as a mesh of a scene's first material.
Mesh mesh_of(Object object);

/// Mesh `mesh` of a scene file, in its own space; an empty name: the whole scene at rest.
Expected<Object> load_object(const std::filesystem::path& file, const std::string& mesh, std::string name);

/// Three-dimensional snowflake: `depth` times each triangle, of an icosahedron at first, gives way to six,
/// with a tetrahedron on its middle; 20 x 6^depth triangles.
Object make_flake(int depth);

/// Closed tube along a torus knot of 2 and 3 turns; 2 x around x across triangles.
Object make_knot(int around, int across);

/// Each triangle split into four, `times` times: same surface, 4^times as many triangles.
Object subdivided(const Object& object, int times);

/// Root that holds `bart` and `extra`: `data`, its parent if it is the folder `bart`, or the folder beside
/// the checkout where it is empty.
std::filesystem::path scene_root(const std::filesystem::path& data);

/// What the error tables show: a bundled object, a bundled robot's head, bunny and FlightHelmet, and a
/// flake. What is missing is named in `notes`, one sentence each.
Expected<std::vector<Object>> error_objects(const std::filesystem::path& data,
                                            std::vector<std::string>& notes);

/// Three meshes for crowds: bunny, spot and a flake, or generated ones of as many triangles where the files
/// are missing (named in `notes`). All have a diameter of 2 or less and stand on y = 0.
std::vector<Object> crowd_objects(const std::filesystem::path& data, std::vector<std::string>& notes);

}  // namespace tenebra::bench
