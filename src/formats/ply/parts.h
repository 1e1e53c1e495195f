// The two lists of a PLY file that make a mesh.
#pragma once

#include <tenebra/scene.h>
#include "formats/ply/header.h"

namespace tenebra::formats::ply {

/// What the vertices say beside their places, into `mesh`; coordinates if `textured`; what is not used into
/// `unused`. Normals keep the file's axes and lengths. Returns the places, in the file's coordinates.
std::vector<glm::dvec3> read_vertices(const Element& element, bool textured, Values& values, Mesh& mesh,
                                      std::vector<UnusedContent>& unused);

/// PLY's v points up, ours down.
glm::vec2 coordinates_of(double s, double t);

/// Adds the faces or the strips of `element` to `mesh`, which has its vertices, with the materials below
/// `materials`. If `textured`, corners that have coordinates of their own get vertices of their own. Returns
/// how many faces were left out, as they have fewer than three corners.
std::uint64_t read_faces(const Element& element, bool textured, std::size_t materials, Values& values,
                         Mesh& mesh, std::vector<UnusedContent>& unused);

}  // namespace tenebra::formats::ply
